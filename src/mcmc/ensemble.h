// All chains of a render, and the image that they make.
#pragma once

#include "mcmc/bootstrap.h"
#include "mcmc/chain.h"
#include "mcmc/noise.h"
#include "render/integrator/integrator.h"

namespace h2mc {

struct MetropolisMethod;

// Chains run in epochs. In the first, the target is the luminance; each of the later ones, three times
// as long as all before it together, divides it by what the picture is known to look like by then
// (ImportanceMap), unless the options switch that off, and mixes its kernels as they have done so far.
// The chains' states go over to the new target by importance resampling. Every epoch's image by itself
// tends to the right one; the result is their mean, each with its number of mutations.
class ChainEnsemble {
 public:
  // Chains start from the bootstrap's samples. Keeps references, but not to the request.
  ChainEnsemble(const Scene& scene, const MetropolisMethod& method, const OptionSet& options,
                const Bootstrap& bootstrap, int minLength, int maxLength,
                const RenderRequest& request);

  int groups() const { return static_cast<int>(groups_.size()); }
  int chains() const { return chains_; }

  // Makes `steps` mutations with each chain of a group. Groups may run in parallel.
  void run(int group, long long steps);

  // Whether the epoch is over. Then nextEpoch() may be called, between two runs; `direct` is an image
  // of what the chains leave out, in the scene's units, or null.
  bool epochIsOver() const;
  void nextEpoch(const Image* direct);
  // How many times as many mutations as now the next epoch's end will have seen.
  static constexpr double kGrowth = 4;

  // The present epoch's picture by every second group and by the others, in the scene's units.
  TwoEstimates halves() const;
  double mutationsPerPixel() const;
  // Edge of the square cells, in pixels, for which the picture so far is known well enough.
  int cell() const;

  // Image, number of mutations, mean luminance and statistics of all so far; leaves the chains as they
  // are.
  RenderResult result() const;

 private:
  struct Group {
    ChainFilms films;
    KernelMixture kernels;
    ChainStatistics statistics;
    MutationContext context;
    std::vector<std::unique_ptr<Chain>> chains;
    long long mutationsBefore = 0, largeStepsBefore = 0;  // the present epoch
  };
  // The images of past epochs. Were L the mean luminance of the image, known in the end: the sum of
  // L * perLuminance + rest, which is what an epoch's states, scaled so that together with the samples of
  // its large steps they have the luminance L, and those samples add up to.
  struct Accumulated {
    std::vector<Rgbf> perLuminance, rest;
    double mutations = 0;
    void add(const Image& states, double statesLuminance, const Image& samples,
             double samplesLuminance, double mutations);
    Image image(const FilmSettings& film, double luminance) const;
  };

  ChainStatistics statistics() const;
  double perPixel(double mutations) const;
  // What the groups first, first + step, .. have done in the present epoch.
  void addEpoch(Accumulated& accumulated, std::size_t first, std::size_t step) const;
  // Mean luminance of the image, with its standard error: bootstrap samples and large steps both
  // estimate it without bias.
  struct Luminance {
    double mean, error;
  };
  Luminance luminance(const ChainStatistics& total) const;
  // By the picture of all past epochs, and what the chains leave out.
  ImportanceMap nextMap(double brightness, const Image* direct) const;
  // A start for each chain under the next map: their states, in proportion to what the new target is
  // of the present one.
  std::vector<Path> resampled(const ImportanceMap& next) const;

  const Scene& scene_;
  const Bootstrap& bootstrap_;
  std::uint64_t seed_;
  int threads_, maxLength_, chains_;
  bool useMap_;
  ImportanceMap importance_;
  SceneTarget target_;
  TechniqueDistribution techniques_;
  double largeStepWeight_ = 1;  // against bootstrap samples, in the mean luminance
  std::vector<Group> groups_;
  Accumulated past_;
  int epoch_ = 0;
};

}  // namespace h2mc
