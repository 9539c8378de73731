// SPDX-License-Identifier: MIT
// Bidirectional samples beside the chains: the picture's base, which chains need not make.
#pragma once

#include "mcmc/chain/kernel_mixture.h"
#include "mcmc/targets/target.h"
#include "render/core/low_discrepancy.h"

namespace h2mc {

// Those that one group of chains makes: numbers part, part + parts, part + 2 parts ... of a sequence, whose number n
// goes through the n-th point of a low-discrepancy sequence on the film, shifted by the seed. Groups that share a
// sequence spread their samples evenly over the film together; sequences are independent of each other. Each half of
// the chains has its own, as the variance is told from what the halves differ by: of one sequence between them each
// half would get every second stripe of the film.
class BaseSamples {
 public:
  // Keeps a reference.
  BaseSamples(const PathTarget& target, int minLength, std::uint64_t seed);

  // Goes over to these numbers of sequence `sequence`, 0 or above. To be called before the first sample, too.
  void begin(int sequence, int part, int parts);

  // Adds samples until there are so many for these mutations, counted from begin() on.
  void extendTo(double samplesAMutation, long long mutations, const Division& division,
                SampleFilm& film, NotFiniteCounts& notFinite);
  // Their luminances, each an estimate of the film's mean.
  const Moments& luminance() const { return luminance_; }
  void archive(Archive& archive) { archive(luminance_, made_); }

 private:
  void add(const Division& division, SampleFilm& film, NotFiniteCounts& notFinite);

  const PathTarget& target_;
  int minLength_;
  std::uint64_t seed_;
  std::uint64_t sequence_ = 0, part_ = 0, parts_ = 1;
  UnitSquarePoint shift_{};
  BidirectionalSampler sampler_;
  Moments luminance_;
  long long made_ = 0;  // since begin()
};

}  // namespace h2mc
