// SPDX-License-Identifier: MIT
// Who the chains are.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mcmc/populations/bootstrap.h"

namespace h2mc {

// States for the chains to go on from. Those before index `half` and the others come from starts that have
// nothing in common, so that the pictures of either half are independent estimates.
struct Members {
  std::vector<Path> states;
  std::size_t half = 0;
};

// How chains start, and what becomes of them between two epochs, when the target changes. Whatever it does
// depends on its arguments alone, and not on the number of threads.
class Population {
 public:
  virtual ~Population() = default;

  // `count` states from the bootstrap, distributed in proportion to their luminance.
  virtual Members start(const Bootstrap& bootstrap, std::size_t count, int maxLength,
                        std::uint64_t seed, int threads) const = 0;

  // As many as there are states now, distributed as the new target if the present ones are as the present one.
  // weights[k]: the new target of state k over its present one, > 0. The states' targets stay as they are.
  virtual Members renew(std::span<const Path* const> states, std::size_t half,
                        std::span<const double> weights, Random& random) const = 0;
};

// Chains that start evenly spread over the bootstrap's samples, and are resampled for each new target: none gets
// more than its share by chance.
std::unique_ptr<Population> resampledChains();

}  // namespace h2mc
