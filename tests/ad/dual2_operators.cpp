// SPDX-License-Identifier: MIT
// The operators of Dual2 against closed forms, for every size and both precisions.

#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

constexpr int kLast = 17;

TEST(AdDual2, BinaryOperators) {
  std::mt19937 random(1);
  forEachSize<kLast>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(1.25), random), b = randomDual<T, N>(T(-0.75), random);
    const Expected ea = expand(a), eb = expand(b);
    const Extended x = a.v, y = b.v;
    expectNear(a + b, chainOf(ea, eb, {x + y, 1, 1, 0, 0, 0}), 4, "a + b");
    expectNear(a - b, chainOf(ea, eb, {x - y, 1, -1, 0, 0, 0}), 4, "a - b");
    expectNear(a * b, chainOf(ea, eb, {x * y, y, x, 0, 1, 0}), 8, "a * b");
    expectNear(a / b,
               chainOf(ea, eb, {x / y, 1 / y, -x / (y * y), 0, -1 / (y * y), 2 * x / (y * y * y)}),
               16, "a / b");
    expectNear(a * a, chainOf(ea, x * x, 2 * x, 2), 8, "a * a");
    expectConstant(a - a, T(0), "a - a");
    auto d = a;
    d += b;
    expectNear(d, expand(a + b), 4, "+=");
    d = a;
    d -= b;
    expectNear(d, expand(a - b), 4, "-=");
    d = a;
    d *= b;
    expectNear(d, expand(a * b), 4, "*=");
    d = a;
    d /= b;
    expectNear(d, expand(a / b), 4, "/=");
    d = a;
    d *= d;
    expectNear(d, expand(a * a), 4, "*= itself");
  });
}

TEST(AdDual2, OperatorsWithPlainNumbers) {
  std::mt19937 random(2);
  forEachSize<kLast>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(1.25), random);
    const Expected e = expand(a);
    const Extended x = a.v;
    const T s = T(-2.5);
    expectNear(-a, chainOf(e, -x, -1, 0), 1, "-a");
    expectNear(+a, chainOf(e, x, 1, 0), 1, "+a");
    expectNear(a + s, chainOf(e, x - 2.5L, 1, 0), 4, "a + s");
    expectNear(s + a, chainOf(e, x - 2.5L, 1, 0), 4, "s + a");
    expectNear(a - s, chainOf(e, x + 2.5L, 1, 0), 4, "a - s");
    expectNear(s - a, chainOf(e, -2.5L - x, -1, 0), 4, "s - a");
    expectNear(a * s, chainOf(e, -2.5L * x, -2.5L, 0), 4, "a * s");
    expectNear(s * a, chainOf(e, -2.5L * x, -2.5L, 0), 4, "s * a");
    expectNear(a / s, chainOf(e, x / -2.5L, 1 / -2.5L, 0), 4, "a / s");
    expectNear(s / a, chainOf(e, -2.5L / x, 2.5L / (x * x), -5 / (x * x * x)), 16, "s / a");
    expectNear(a * 3, chainOf(e, 3 * x, 3, 0), 4, "a * int");
    expectNear(3 / a, chainOf(e, 3 / x, -3 / (x * x), 6 / (x * x * x)), 16, "int / a");
    expectNear(2.5 * a + 1.0, chainOf(e, 2.5L * x + 1, 2.5L, 0), 4, "double * a");
    auto d = a;
    d += 2;
    d -= T(1);
    d *= 3.0;
    d /= T(2);
    expectNear(d, chainOf(e, (x + 1) * 1.5L, 1.5L, 0), 8, "compound");
  });
}

}  // namespace
}  // namespace h2mc::ad
