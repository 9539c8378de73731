// SPDX-License-Identifier: MIT
#include "mcmc/populations/resampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace h2mc {

std::vector<std::size_t> systematicResampling(std::span<const double> weights, std::size_t count,
                                              double offset) {
  std::vector<double> cumulative(weights.size());
  std::partial_sum(weights.begin(), weights.end(), cumulative.begin());
  std::vector<std::size_t> indices;
  indices.reserve(count);
  std::size_t k = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at =
        (static_cast<double>(i) + offset) / static_cast<double>(count) * cumulative.back();
    while (k + 1 < weights.size() && cumulative[k] <= at) ++k;
    indices.push_back(k);
  }
  return indices;
}

std::size_t systematicShare(double probability, std::size_t count, double offset) {
  return std::min(count,
                  static_cast<std::size_t>(static_cast<double>(count) * probability + offset));
}

ResampledHalves resampleHalves(std::span<const double> weights, std::size_t half, std::size_t count,
                               Random& random) {
  const std::span<const double> parts[2] = {weights.first(half), weights.subspan(half)};
  double sums[2];
  for (int h = 0; h < 2; ++h) sums[h] = std::accumulate(parts[h].begin(), parts[h].end(), 0.0);
  ResampledHalves result;
  result.half = systematicShare(sums[0] / (sums[0] + sums[1]), count, random.uniformDouble());
  for (int h = 0; h < 2; ++h) {
    const std::size_t own = h == 0 ? result.half : count - result.half;
    const double offset = random.uniformDouble();
    if (own == 0) continue;
    for (const std::size_t k : systematicResampling(parts[h], own, offset))
      result.indices.push_back(h == 0 ? k : half + k);
  }
  return result;
}

}  // namespace h2mc
