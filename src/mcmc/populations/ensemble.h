// SPDX-License-Identifier: MIT
// All chains of a render, and the image that they make.
#pragma once

#include "mcmc/chain/chain.h"
#include "mcmc/methods/method.h"
#include "mcmc/populations/base_samples.h"
#include "mcmc/populations/bootstrap.h"
#include "mcmc/populations/image_estimate.h"
#include "mcmc/populations/luminance_estimate.h"
#include "mcmc/populations/population.h"
#include "mcmc/populations/replicas.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// Chains run in epochs. In the first, the target is the luminance; each of the later ones, three times
// as long as all before it together, divides it by what the picture is known to look like by then
// (ImportanceMap), unless the options switch that off, and mixes its kernels as they have done so far.
// The chains' states go over to the new target as the population does it. Every epoch's image by itself
// tends to the right one; the result is their mean, each with its number of mutations.
class ChainEnsemble {
 public:
  // Chains start from the bootstrap's samples. `affordable`: how many bidirectional samples a pixel there would be time
  // for; infinite where the budget is no time. Keeps references, but not to the request.
  ChainEnsemble(const Scene& scene, const MetropolisMethod& method, const OptionSet& options,
                const Bootstrap& bootstrap, int minLength, int maxLength,
                const RenderRequest& request, double affordable);

  int groups() const { return static_cast<int>(groups_.size()); }
  int chains() const { return static_cast<int>(chains_.size()); }

  // Makes `steps` mutations with each chain of a group. Groups may run in parallel.
  void run(int group, long long steps);
  // Adds what all groups have made to the picture. To be called between one round of runs and the next. Ranks bring it
  // together: throws RankLost, having added nothing.
  void endRound();
  // Of all ranks, between two rounds: brings together where their chains stand and what they have counted. To be called
  // before nextEpoch(), result() and archive(). Throws RankLost.
  void gather();

  // Whether the epoch is over. Then endEpoch() and nextEpoch() may be called, between two rounds; `direct` is
  // an image of what the chains leave out, in the scene's units, or null.
  bool epochIsOver() const;
  void endEpoch() { image_.end(); }
  void nextEpoch(const Image* direct);

  // The present epoch's picture by either half of the chains, in the measured rows and in the scene's units.
  TwoEstimates halves() const { return image_.halves(luminance().mean); }
  // Learns, for the next epoch, how many base samples there should be, from the noise of this one's states and samples,
  // unless the options say. Of the measured rows' pixels, `weights` are those of varianceOfOneSample().
  void measure(const std::vector<double>& weights);
  // What a mutation costs from now on, the base samples beside it included, over what it costs by itself.
  double mutationCost() const;
  double mutationsPerPixel() const;
  // Edge of the square cells, in pixels, for which the picture so far is known well enough.
  int cell() const;

  // Where all chains stand and what was added and learned, between two rounds. Reading: into an ensemble made with the
  // same arguments. Throws ArchiveError.
  void archive(Archive& archive);

  // Image, number of mutations, mean luminance and statistics of all so far; changes nothing.
  RenderResult result() const;

 private:
  // Chains that one thread runs, with what they must not share.
  struct Group {
    ChainFilms films;
    KernelMixture kernels;
    ChainStatistics statistics;
    MutationContext context;
    std::unique_ptr<BaseSamples> base;  // null: none
    std::unique_ptr<Replicas> replicas = nullptr;
    std::size_t begin = 0, end = 0;  // of its chains
    int half = 0;
    long long mutationsBefore = 0, samplesBefore = 0;  // the present round
    long long mutationsOfPast = 0;                     // epochs

    // Large steps included.
    Moments samples() const {
      Moments all = statistics.largeSteps;
      if (base) all.add(base->luminance());
      return all;
    }
  };

  void archiveGroup(Archive& archive, Group& group);
  // Puts replicas beside the groups' chains, where the options ask for them.
  void addReplicas(const MetropolisMethod& method, const OptionSet& options, int minLength);
  nlohmann::json replicasJson() const;
  // Deals the chains and the epoch's base samples out to the groups, each of which has those of one half.
  void formGroups(std::size_t half);
  ChainStatistics statistics() const;
  double perPixel(double mutations) const;
  LuminanceEstimate::Value luminance() const { return luminance_.with(samples()); }
  // Of all groups, in their order.
  Moments samples() const;
  Moments baseSamples() const;
  // By the picture of all past epochs, and what the chains leave out.
  ImportanceMap nextMap(double luminance, const Image* direct) const;
  // States for the chains to go on from under the next map.
  Members renewed(const ImportanceMap& next) const;

  const Scene& scene_;
  std::uint64_t seed_;
  int threads_, maxLength_;
  Ranks* ranks_;
  bool useMap_;
  ImportanceMap importance_;
  SceneTarget target_;
  TechniqueDistribution techniques_;
  LuminanceEstimate luminance_;
  std::unique_ptr<Population> population_;
  std::vector<std::unique_ptr<Chain>> chains_;
  std::size_t half_ = 0;  // so many of them are of the first half
  std::vector<Group> groups_;
  PixelStatistics statistics_;
  ImageEstimate image_;
  int epoch_ = 0;
  bool learnsBase_;
  double stateNoise_ = 0, sampleNoise_ = 0;  // of one mutation or sample a pixel, as measured
};

}  // namespace h2mc
