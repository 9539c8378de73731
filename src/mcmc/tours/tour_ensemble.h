// SPDX-License-Identifier: MIT
// All tours of a render, and the picture that they make.
#pragma once

#include "mcmc/tours/limited_target.h"
#include "mcmc/tours/tour_group.h"
#include "mcmc/tours/tour_method.h"
#include "mcmc/tours/tour_picture.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// In each round every group makes one batch. Between two epochs, each of which ends with four times the mutations of
// the one before, the mixture's shares are learned from what was accepted so far: those of a tour depend on none but
// those that were over before.
class TourEnsemble {
 public:
  static constexpr int kGroups = 32;

  // Keeps references, but not to the request. `meanLuminance`: about that of the film, > 0.
  TourEnsemble(const Scene& scene, const TourMethod& method, const OptionSet& options,
               double meanLuminance, int minLength, int maxLength, const RenderRequest& request);

  // Batch number `batch`, by group number batch % kGroups. Groups may run in parallel.
  void run(long long batch);
  // Adds what all groups have made to the picture. To be called between one round of runs and the next.
  // Ranks bring it together: throws RankLost, having added nothing.
  void endRound();
  // Of all ranks, before nextEpoch(), result() and archive(): as ChainEnsemble's. Throws RankLost.
  void gather();

  bool epochIsOver() const;
  void nextEpoch();

  double mutationsPerPixel() const;
  // The picture by either half of the batches, in the measured rows and in the scene's units.
  TwoEstimates halves() const;

  // Throws ArchiveError.
  void archive(Archive& archive);
  // Image, number of mutations, mean luminance and statistics of all so far; changes nothing.
  RenderResult result() const;

 private:
  TourCounts counts() const;
  ChainStatistics statistics() const;

  const Scene& scene_;
  PixelStatistics asked_;
  int threads_;
  Ranks* ranks_;
  LimitedTarget target_;
  std::unique_ptr<TourRule> rule_;
  std::vector<TourGroup> groups_;
  std::array<long long, kGroups> samplesBefore_{};  // the present round
  TourPicture picture_;
  int epoch_ = 0;
};

}  // namespace h2mc
