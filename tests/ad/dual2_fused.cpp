// SPDX-License-Identifier: MIT
// Fused sums of Dual2 against the operators, and identities, for every size and both precisions.

#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

constexpr int kLast = 17;

TEST(AdDual2, FusedSums) {
  std::mt19937 random(3);
  forEachSize<kLast>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(1.25), random), b = randomDual<T, N>(T(-0.75), random),
               d = randomDual<T, N>(T(2), random), x = randomDual<T, N>(T(0.5), random),
               y = randomDual<T, N>(T(3), random), z = randomDual<T, N>(T(-1.5), random);
    const T s = T(0.3), t = T(-1.7), u = T(2.2);
    expectNear(dot2(a, x, b, y), expand(a * x + b * y), 16, "dot2");
    expectNear(differenceOfProducts(a, x, b, y), expand(a * x - b * y), 16, "difference");
    expectNear(dot3(a, x, b, y, d, z), expand(a * x + b * y + d * z), 16, "dot3");
    expectNear(sumOfSquares3(a, b, d), expand(a * a + b * b + d * d), 16, "sumOfSquares3");
    expectNear(linear2(a, s, b, t), expand(a * s + b * t), 16, "linear2");
    expectNear(linear3(a, s, b, t, d, u), expand(a * s + b * t + d * u), 16, "linear3");
  });
}

TEST(AdDual2, Identities) {
  std::mt19937 random(4);
  forEachSize<kLast>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(1.25), random), b = randomDual<T, N>(T(-0.75), random),
               d = randomDual<T, N>(T(2), random);
    expectNear((a / b) * b, expand(a), 100, "a / b * b");
    expectNear((a + b) * d, expand(a * d + b * d), 64, "distributive");
    expectNear(a * (b * d), expand((a * b) * d), 64, "associative");
    expectNear(1 / (1 / a), expand(a), 100, "1 / (1 / a)");
  });
}

}  // namespace
}  // namespace h2mc::ad
