// SPDX-License-Identifier: MIT
// Bidirectional samples beside the chains: the picture's base, which chains need not make.
#pragma once

#include "mcmc/chain/kernel_mixture.h"
#include "mcmc/targets/target.h"
#include "render/core/low_discrepancy.h"

namespace h2mc {

// Those that one group of chains makes. All groups' samples together are spread evenly over the film: number n goes
// through the n-th point of a low-discrepancy sequence, shifted by the seed.
class BaseSamples {
 public:
  // Group `group` of `groups`. Keeps a reference.
  BaseSamples(const PathTarget& target, int minLength, std::uint64_t seed, int group, int groups);

  // Adds samples until there are so many for these mutations, counted since the last call of restart().
  void extendTo(double samplesAMutation, long long mutations, const Division& division,
                SampleFilm& film, NotFiniteCounts& notFinite);
  // Mutations are counted from 0 again.
  void restart() { sinceRestart_ = 0; }

  // Their luminances, each an estimate of the film's mean.
  const Moments& luminance() const { return luminance_; }
  void archive(Archive& archive) { archive(luminance_, sinceRestart_); }

 private:
  void add(const Division& division, SampleFilm& film, NotFiniteCounts& notFinite);

  const PathTarget& target_;
  int minLength_;
  std::uint64_t seed_;
  std::uint64_t group_, groups_;
  UnitSquarePoint shift_;
  BidirectionalSampler sampler_;
  Moments luminance_;
  long long sinceRestart_ = 0;
};

}  // namespace h2mc
