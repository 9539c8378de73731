// SPDX-License-Identifier: MIT
// What path, bdpt and photon share: a number of samples for each pixel, added up on a film.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "render/core/random.h"
#include "render/integrator/integrator.h"
#include "render/integrator/memory_need.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/sample_tally.h"
#include "render/integrator/splat_list.h"
#include "render/scene/scene.h"

namespace h2mc {

// Draws the samples of one group: owns what must not be shared.
class PixelSampler {
 public:
  virtual ~PixelSampler() = default;
  // Adds one sample to the list, whose camera ray passes through (filmX, filmY).
  // Returns the luminance of all that it has added.
  virtual double sample(const Scene& scene, Random& random, float filmX, float filmY,
                        SplatList& film, SampleTally& tally) = 0;
};
using MakeSampler = std::function<std::unique_ptr<PixelSampler>()>;

// What the samples of a pass have in common, where they have anything. Their sum is then as uncertain as passes are.
struct SharedByPass {
  std::function<void(long long pass)>
      begin;  // called before the first round of it, 0, 1, ..; and before the first
              // round of a render that goes on within it
  std::function<void(nlohmann::json&)> addStatistics;
  MemoryItem memory{};
};

// A film and the samples on it: in each pass one for every pixel, or in one that was cut short one for some of them,
// spread evenly, which are drawn by the seed: every pixel is as likely to have one. Memory: a
// film, and 24 bytes for each splat of the 65,000 samples that a round has at most.
class SampledFilm {
 public:
  // Keeps a reference to the scene. `step`: as BasicFilm's. With statistics another film has every other pass.
  // `shared`: begin and the tally of passes are what it makes use of.
  SampledFilm(const Scene& scene, const MakeSampler& makeSampler, int step = 0,
              PixelStatistics statistics = {}, const SharedByPass& shared = {});

  // Rounds in a pass.
  long long roundsAPass() const { return static_cast<long long>(side_) * side_; }
  // Adds samples by a plan in rounds, to one half of the film. Sample i of a pixel draws from
  // Random(seed, pixel, i): a further call needs another seed.
  RoundsResult add(const RenderRequest& request, const RenderClock& clock, RoundsPlan plan,
                   int half = 0);

  // What was added, between two rounds.
  void archive(Archive& archive);

  const Film& film() const { return film_; }
  SampleTally tally(int half) const;
  // The standard error of tally(0)'s mean luminance.
  double meanLuminanceError() const;
  // Of the picture that all samples make; the statistics have to be asked for. Samples of different passes are
  // independent.
  Image variance(int threads) const;
  // How many samples there are on each pixel.
  std::vector<float> counts() const { return {counts_.begin(), counts_.end()}; }

 private:
  struct Counts {
    SampleTally tally[2];
    long long inEven = 0;  // samples of passes 0, 2, ..
  };
  struct Group : Counts {
    std::unique_ptr<PixelSampler> sampler;
    SplatList splats;
    Counts before;  // the round, where there are ranks
  };
  // Calls visit(x, y, pass) for the pixels of a group's share of a round.
  template <class Visit>
  void forEachPixel(int group, long long round, std::uint64_t seed, const Visit& visit) const;
  void sample(int group, long long round, std::uint64_t seed, int half);
  // Brings together what the ranks have made of a round. Throws RankLost, the round being forgotten.
  void gather(const RenderRequest& request, long long round);

  const Scene& scene_;
  int side_;  // a round has one pixel of each square of side x side
  Film film_;
  std::optional<Film> even_;           // of passes 0, 2, ..
  std::vector<std::uint32_t> counts_;  // by pixel
  std::vector<Group> groups_;
  std::function<void(long long)> beginPass_;  // where samples of a pass share anything
  PassTally passes_;                          // where they do
};

// Samples, in all, a pixel and a second; what was not finite; mean luminance with its error, in the file's units.
nlohmann::json sampleStatistics(const Scene& scene, const SampleTally& tally, double seconds);

// Renders samplesPerPixel passes (or by time) with a sampler for each group.
RenderResult renderSamples(const Scene& scene, const RenderRequest& request,
                           int defaultSamplesPerPixel, const MakeSampler& makeSampler,
                           const SharedByPass& shared = {});

}  // namespace h2mc
