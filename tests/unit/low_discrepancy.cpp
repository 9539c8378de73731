// SPDX-License-Identifier: MIT
#include "render/core/low_discrepancy.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace h2mc {
namespace {

// Of each 64 consecutive points every box of area 1 / 64, of any shape, has one.
TEST(SobolPoints, FillEveryElementaryBox) {
  constexpr int kBits = 6, kPoints = 1 << kBits;
  for (const std::uint64_t first : {0ull, 64ull, 640ull, (1ull << 32) - 64})
    for (int columnBits = 0; columnBits <= kBits; ++columnBits) {
      const auto columns = static_cast<float>(1 << columnBits);
      const auto rows = static_cast<float>(1 << (kBits - columnBits));
      std::set<std::pair<int, int>> boxes;
      for (std::uint64_t n = first; n < first + kPoints; ++n) {
        const UnitSquarePoint p = sobolPoint(n);
        EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
        boxes.insert({static_cast<int>(p.x * columns), static_cast<int>(p.y * rows)});
      }
      EXPECT_EQ(boxes.size(), kPoints) << "from " << first << ", " << columns << " columns";
    }
}

TEST(SobolPoints, BeginAsTheyShould) {
  const std::pair<float, float> expected[] = {
      {0, 0}, {0.5f, 0.5f}, {0.25f, 0.75f}, {0.75f, 0.25f}, {0.125f, 0.625f}};
  for (std::uint64_t n = 0; n < 5; ++n) {
    const UnitSquarePoint p = sobolPoint(n);
    EXPECT_EQ(std::pair(p.x, p.y), expected[n]) << n;
  }
}

}  // namespace
}  // namespace h2mc
