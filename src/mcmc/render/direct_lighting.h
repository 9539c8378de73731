// SPDX-License-Identifier: MIT
// The shortest paths by path tracing, beside the chains: a Metropolis chain is wasted on them.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "mcmc/render/noise.h"
#include "render/integrator/sampling_integrator.h"
#include "render/scene/option_set.h"

namespace h2mc {

// What DirectLighting::add() is about to add.
struct DirectLightingPart {
  double seconds = 0;
  long long samples = 0;
  int half = 0;        // that gets samples now
  bool begun = false;  // of that half
  std::uint64_t seed = 0;
  long long rounds = 0;                    // of that half, made
  double halfSeconds = 0, allSeconds = 0;  // spent on it, and on the whole part
  std::unique_ptr<SampledFilm> film;
  Image first;  // the film's sums when half 0 was done, for variances
};

// Paths of one and two edges, in parts: each makes it less noisy. First as much of it as every render
// can use, then, when the chains know their own noise, as much as makes the whole picture's least.
class DirectLighting {
 public:
  // In edges, where maxDepth allows: path tracing does not find what a beam lights.
  static int longest(const Scene& scene) { return scene.hasBeam() ? 1 : 2; }

  // By the options minDepth, maxDepth and directSamples; the request's seed, threads, stop flag and
  // progress, which is called while it renders.
  // Keeps references.
  DirectLighting(const Scene& scene, const OptionSet& options, const RenderRequest& request);

  // To be called after each round of samples; null: nothing is.
  void setWatch(std::function<void()> watch) { watch_ = std::move(watch); }
  // All that was made; in a call of the watch too. After reading, finishPart() completes what was under way then.
  void archive(Archive& archive);
  void finishPart();
  // Calls work() without counting its time; in a call of the watch.
  void pause(const std::function<void()>& work);

  // Whether it is split off from the chains at all.
  bool wanted() const { return wanted_ != 0 && minDepth_ <= longest_; }
  bool interrupted() const { return interrupted_; }
  // In the scene's units; empty before the first sample.
  const Image& image() const { return sums_.image; }

  // Brings it up to the least that a render of so many seconds, or of so many mutations a pixel,
  // gets. Both may only grow from call to call.
  void extendTo(double renderSeconds, long long mutationsPerPixel);

  // Of the measured rows, what makes errors relative to the whole picture: relativeWeights of its own and of the
  // chains' picture, which is in the scene's units and known by cells of cell x cell pixels.
  std::vector<double> weights(const Image& chains, int cell) const;
  // Measures its noise and that of the chains, with these weights.
  void measure(const TwoEstimates& chains, const std::vector<double>& weights);
  // What measure() has found of its own, for the samples that there are: a share of relMSE; 0 before.
  double noise() const;
  // Where a render stands.
  struct Standing {
    double mutations = 0;     // a pixel, so far
    double chainSeconds = 0;  // of them
    double mutationCost =
        1;  // of one with what is beside it, where the clock must not matter, over one alone
    double seconds = 0;     // of everything
    double endSeconds = 0;  // of the render, or of its part up to the next mark; 0: by endMutations
    double endMutations = 0;  // a pixel
    double growth = 1;        // there will be another call before so many times the mutations
  };
  // Brings it up to what makes the variance of the whole picture least, by what was measured, when the
  // render is over or when it has `growth` times the mutations. A number given by the option
  // directSamples stays. By what samples and mutations have cost where the budget is a time, else at
  // a fixed price, so that the picture does not depend on the clock. As the number then depends on the
  // samples before, their mean is biased: by a few hundredths of its standard error where few samples
  // decide, and by less the more there are.
  void balance(const Standing& now);
  // Wall seconds so far.
  double seconds() const { return seconds_; }

  // Adds image, mean luminance and statistics to those of the longer paths, whose image may be
  // empty.
  void addTo(RenderResult& result) const;
  // Contributions that were not finite and are left out.
  long long notFinite() const { return tally().notFinite; }

 private:
  using Part = DirectLightingPart;
  // One of two independent halves.
  struct Half {
    SampleTally tally;
    Image rows;  // its own picture, in the measured rows
    void archive(Archive& archive) { archive(tally, rows); }
  };
  struct Sums {
    std::array<Half, 2> halves;
    Image image;
    Image first;  // half 0's picture, for variances
  };
  // More samples, half of them in each half: until there are so many a pixel, and so many seconds are over; 0:
  // the other is the only limit.
  void add(double seconds, long long samples);
  // Its picture by either half, in the measured rows.
  TwoEstimates ownRows() const;
  std::unique_ptr<SampledFilm> makeFilm() const;
  void addHalf(Part& part);
  // The sums, with the part's samples.
  Sums with(Sums sums, const Part& part) const;
  // Of the sums' picture.
  Image variance(const Sums& sums) const;
  static SampleTally tally(const std::array<Half, 2>& halves);
  SampleTally tally() const { return tally(sums_.halves); }
  // A pixel; no whole numbers where the time was short.
  double perPixel(const SampleTally& tally) const;

  const Scene& scene_;
  const RenderRequest& request_;
  int wanted_, minDepth_, longest_, step_;  // every so many-th row is measured
  double renderSeconds_ = 0;                // of renders so far
  double perSample_ = 0, perMutation_ = 0;  // measured variances
  std::uint64_t parts_ = 0;                 // a seed each
  Sums sums_;
  std::optional<Part> part_;
  double seconds_ = 0;
  bool interrupted_ = false;
  std::function<void()> watch_;
  RenderClock* partClock_ = nullptr;  // of the samples that are being made
};

}  // namespace h2mc
