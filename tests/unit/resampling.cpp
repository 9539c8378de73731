// SPDX-License-Identifier: MIT
#include "mcmc/populations/resampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/core/index.h"

namespace h2mc {
namespace {

const std::vector<double> kWeights = {0.5, 0, 3, 1e-9, 7, 0.25, 0.25, 2, 0, 11};

double sum(std::span<const double> weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

std::vector<int> counts(std::span<const std::size_t> indices, std::size_t size) {
  std::vector<int> result(size, 0);
  for (const std::size_t k : indices) ++result.at(k);
  return result;
}

TEST(SystematicResampling, TakesFloorOrCeilOfTheShare) {
  for (const std::size_t count : {1u, 2u, 7u, 24u, 100u})
    for (const double offset : {0.0, 0.25, 0.5, 0.9999}) {
      const std::vector<std::size_t> indices = systematicResampling(kWeights, count, offset);
      ASSERT_EQ(indices.size(), count);
      EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
      const std::vector<int> taken = counts(indices, kWeights.size());
      for (std::size_t k = 0; k < kWeights.size(); ++k) {
        const double share = static_cast<double>(count) * kWeights[k] / sum(kWeights);
        EXPECT_GE(taken[k], std::floor(share - 1e-9)) << k;
        EXPECT_LE(taken[k], std::ceil(share + 1e-9)) << k;
      }
    }
}

// Offsets at the middles of equal steps: the mean is exact but for the states within a step of a border.
TEST(SystematicResampling, IsRightOnAverage) {
  constexpr int kOffsets = 10000;
  constexpr std::size_t kCount = 13;
  std::vector<double> mean(kWeights.size(), 0);
  for (int i = 0; i < kOffsets; ++i) {
    const auto taken =
        counts(systematicResampling(kWeights, kCount, (i + 0.5) / kOffsets), kWeights.size());
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += taken[k] / double(kOffsets);
  }
  for (std::size_t k = 0; k < mean.size(); ++k)
    EXPECT_NEAR(mean[k], kCount * kWeights[k] / sum(kWeights), 2.0 / kOffsets) << k;
}

TEST(SystematicResampling, OneStateTakesAll) {
  for (const std::vector<double>& weights : {std::vector<double>{4}, {0, 4}, {4, 0}})
    for (const std::size_t k : systematicResampling(weights, 5, 0.999999)) EXPECT_GT(weights[k], 0);
}

TEST(SystematicShare, IsRightOnAverage) {
  for (const double probability : {0.0, 0.07, 0.5, 0.93, 1.0}) {
    double mean = 0;
    constexpr int kOffsets = 10000;
    for (int i = 0; i < kOffsets; ++i) {
      const std::size_t share = systematicShare(probability, 9, (i + 0.5) / kOffsets);
      EXPECT_LE(share, 9u);
      mean += static_cast<double>(share) / kOffsets;
    }
    EXPECT_NEAR(mean, 9 * probability, 2.0 / kOffsets);
  }
}

// Each state as often as without halves, and no state in the other half. By 40,000 repeats: the means are off by
// five standard errors, of a deviation below 0.75, once in two million tries.
TEST(ResampledHalves, AreIndependentAndRightOnAverage) {
  constexpr int kRepeats = 40000;
  constexpr std::size_t kCount = 13;
  for (const std::size_t half : {0u, 4u, 5u, 10u}) {
    std::vector<double> mean(kWeights.size(), 0);
    for (int i = 0; i < kRepeats; ++i) {
      Random random(3, half, static_cast<std::uint64_t>(i));
      const ResampledHalves drawn = resampleHalves(kWeights, half, kCount, random);
      ASSERT_EQ(drawn.indices.size(), kCount);
      for (std::size_t j = 0; j < kCount; ++j) {
        ASSERT_EQ(drawn.indices[j] < half, j < drawn.half);
        mean[drawn.indices[j]] += 1. / kRepeats;
      }
    }
    for (std::size_t k = 0; k < mean.size(); ++k)
      EXPECT_NEAR(mean[k], kCount * kWeights[k] / sum(kWeights), 5 * 0.75 / std::sqrt(kRepeats))
          << half << " " << k;
  }
}

}  // namespace
}  // namespace h2mc
