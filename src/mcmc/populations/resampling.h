// SPDX-License-Identifier: MIT
// Drawing from weighted states so that each is taken as often as it should be, but for rounding.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/core/random.h"

namespace h2mc {

// Systematic resampling [Kitagawa 1996, appendix]: `count` indices, ascending; k turns up floor or ceil of
// count * weights[k] / sum of weights times and, over an offset uniform in [0, 1), so often on average.
// Preconditions: weights >= 0, not all zero.
std::vector<std::size_t> systematicResampling(std::span<const double> weights, std::size_t count,
                                              double offset);

// How many of `count` things, each of which belongs to a first part with this probability, do: floor or ceil of
// count * probability, and on average as many, over an offset uniform in [0, 1).
std::size_t systematicShare(double probability, std::size_t count, double offset);

// The same where the states before index `half` and those from it on are two samples independent of each other
// that are to stay so: no index of one half is among the other's. The halves get systematicShare of `count`, so
// that index k still turns up count * weights[k] / sum times on average.
struct ResampledHalves {
  std::vector<std::size_t> indices;
  std::size_t half = 0;  // so many of them are of the first half
};
ResampledHalves resampleHalves(std::span<const double> weights, std::size_t half, std::size_t count,
                               Random& random);

}  // namespace h2mc
