// SPDX-License-Identifier: MIT
// The judge of derivatives, on functions whose derivatives are known: right, wrong, kinked, noisy.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ad/derivative_check.h"
#include "render/core/index.h"

namespace h2mc::ad {
namespace {

constexpr double kTolerance = 1e-6;

// Three coordinates on which the function varies over 1, 1e-2 and 1e-5.
constexpr double kLength[3] = {1, 1e-2, 1e-5};
constexpr double kAt[3] = {0x0.5p0, 0x0.ap0, 0x0.3p0};

// sin(a) exp(b / 2) + a c^2 + b, with a, b, c the coordinates' distances in lengths.
double smooth(const double* x) {
  const double a = (x[0] - 0.1) / kLength[0], b = (x[1] - kAt[1]) / kLength[1] + 0.3,
               c = (x[2] - kAt[2]) / kLength[2] + 0.7;
  return std::sin(a) * std::exp(b / 2) + a * c * c + b;
}

DerivativeValues exactSmooth() {
  const double a = kAt[0] - 0.1, b = 0.3, c = 0.7, e = std::exp(b / 2);
  DerivativeValues d;
  d.value = smooth(kAt);
  d.gradient = {std::cos(a) * e + c * c, std::sin(a) * e / 2 + 1, 2 * a * c};
  d.hessian = {-std::sin(a) * e, std::cos(a) * e / 2, std::sin(a) * e / 4, 2 * c, 0, 2 * a};
  for (int i = 0; i < 3; ++i) {
    d.gradient[at(i)] /= kLength[i];
    for (int j = 0; j <= i; ++j) d.hessian[at(triangleIndex(i, j))] /= kLength[i] * kLength[j];
  }
  return d;
}

DerivativeCheck check(const PlainFunction& f, const DerivativeValues& exact,
                      double tolerance = kTolerance) {
  constexpr double kSteps[3] = {1.0 / 16, 1.0 / 16, 1.0 / 16};
  const auto n = static_cast<int>(exact.gradient.size());
  return checkDerivative(f, kAt, n, kSteps, exact, tolerance);
}

// A function of the first coordinate's distance from kAt[0] alone.
DerivativeCheck check1(const std::function<double(double)>& f, double value, double gradient,
                       double hessian) {
  return check([&](const double* x) { return f(x[0] - kAt[0]); }, {value, {gradient}, {hessian}});
}

TEST(DerivativeCheck, RightOnAllScales) {
  const DerivativeCheck c = check(smooth, exactSmooth());
  EXPECT_TRUE(c.finite);
  EXPECT_EQ(c.verdict(), Verdict::kAgrees);
  EXPECT_EQ(c.agree, 9);
  EXPECT_LT(c.gradientError, 1e-9);
  EXPECT_LT(c.hessianError, 1e-7);
  for (const EntryCheck& e : c.hessian)
    EXPECT_LE(std::abs(e.exact - e.difference), 10 * e.error) << "the estimated error is too small";
}

TEST(DerivativeCheck, EveryWrongEntryIsFound) {
  for (const double factor : {1 + 1e-4, 0.5, -1.0, 0.0}) {
    for (std::size_t k = 0; k < 9; ++k) {
      DerivativeValues exact = exactSmooth();
      double& entry = k < 3 ? exact.gradient[k] : exact.hessian[k - 3];
      if (entry == 0) continue;
      entry *= factor;
      const DerivativeCheck c = check(smooth, exact);
      EXPECT_EQ(c.verdict(), Verdict::kWrong) << "entry " << k << " times " << factor;
      EXPECT_EQ(c.wrong, 1);
      EXPECT_EQ((k < 3 ? c.gradient[k] : c.hessian[k - 3]).verdict, Verdict::kWrong);
    }
  }
  DerivativeValues exact = exactSmooth();
  exact.hessian[4] = 1e3;  // a zero between the coordinates of lengths 1e-2 and 1e-5
  EXPECT_EQ(check(smooth, exact).wrong, 1);
  exact = exactSmooth();
  exact.value += 1e-5;
  EXPECT_EQ(check(smooth, exact).verdict(), Verdict::kWrong);
}

TEST(DerivativeCheck, ToleranceDecides) {
  DerivativeValues exact = exactSmooth();
  exact.gradient[1] *= 1 + 1e-4;
  EXPECT_EQ(check(smooth, exact, 1e-3).verdict(), Verdict::kAgrees);
  EXPECT_EQ(check(smooth, exact, 1e-5).verdict(), Verdict::kWrong);
}

// The derivative is what f does in the smallest neighbourhood, not what it does beyond a kink.
TEST(DerivativeCheck, KinkWithinTheStepsIsStillJudged) {
  for (const double distance : {0.05, 1e-2, 1e-3, 1e-4}) {
    const auto f = [=](double x) { return x + x * x + 3 * std::max(0.0, x - distance); };
    EXPECT_EQ(check1(f, 0, 1, 2).verdict(), Verdict::kAgrees) << distance;
    const auto jump = [=](double x) { return x + x * x + (x > distance ? 1 : 0); };
    EXPECT_EQ(check1(jump, 0, 1, 2).verdict(), Verdict::kAgrees) << distance;
    EXPECT_EQ(check1(f, 0, 1, 3).verdict(), Verdict::kWrong) << distance;
  }
}

// A plateau of the differences at large steps that is not the derivative.
TEST(DerivativeCheck, NarrowFeatureAtThePoint) {
  constexpr double kWidth = 1e-6, kSlope = 0.5, kCurvature = 8;
  const auto f = [=](double x) {
    return std::abs(x) < kWidth ? kSlope * x + kCurvature * x * x / 2 : std::sin(x);
  };
  EXPECT_EQ(check1(f, 0, kSlope, kCurvature).wrong, 0);
}

TEST(DerivativeCheck, KinkAtThePointIsNoMistake) {
  // What a derivative to the left says, of a kink in the first and of one in the second derivative.
  EXPECT_EQ(check1([](double x) { return x < 0 ? 2 * x : 5 * x; }, 0, 2, 0).verdict(),
            Verdict::kKink);
  EXPECT_EQ(check1([](double x) { return x < 0 ? x * x : 4 * x * x; }, 0, 0, 2).verdict(),
            Verdict::kKink);
}

// A second difference is not judged where most of those beside it are spoilt.
TEST(DerivativeCheck, NeighboursOfKinksAreNotJudged) {
  // (a + b)^2 + (a + b) (|c| + |d| + ..): mixed second derivatives that jump, none of them along an axis.
  // The exact values are those to the right, but for that by a and b, which is 2.
  const auto checked = [](int kinks) {
    const int n = 2 + kinks;
    const std::vector<double> at(static_cast<std::size_t>(n), 0.5);
    const std::vector<double> steps(at.size(), 1.0 / 16);
    const auto f = [=](const double* x) {
      double sum = 0;
      for (int k = 2; k < n; ++k) sum += std::abs(x[k] - 0.5);
      const double a = x[0] - 0.5, b = x[1] - 0.5;
      return (a + b) * (a + b) + (a + b) * sum;
    };
    DerivativeValues exact{0, std::vector<double>(at.size(), 0), {}};
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j)
        exact.hessian.push_back(i >= 2 ? (j < 2 ? 1 : 0) : (i == j ? 2 : 3));
    return checkDerivative(f, at.data(), n, steps.data(), exact, kTolerance);
  };
  for (const int kinks : {1, 2}) {
    const DerivativeCheck c = checked(kinks);
    for (int k = 2; k < 2 + kinks; ++k)
      for (const int i : {0, 1})
        EXPECT_EQ(c.hessian[at(triangleIndex(k, i))].verdict, Verdict::kKink);
    // Beside it two are in order, and two for each kink are not.
    EXPECT_EQ(c.hessian[1].verdict, kinks == 1 ? Verdict::kWrong : Verdict::kKink);
  }
}

TEST(DerivativeCheck, MixedDifferencesReachAcrossTheKinksOfTheirCoordinates) {
  // (a + b)^2 + b^2 + kink |a|: 2 by a and b, taken for 3.
  for (const double kink : {0.0, 1.0}) {
    const double at[2] = {0.5, 0.5}, steps[2] = {1.0 / 16, 1.0 / 16};
    const auto f = [=](const double* x) {
      const double a = x[0] - 0.5, b = x[1] - 0.5;
      return (a + b) * (a + b) + b * b + kink * std::abs(a);
    };
    const DerivativeValues exact{0, {0, 0}, {2, 3, 4}};
    const DerivativeCheck c = checkDerivative(f, at, 2, steps, exact, kTolerance);
    EXPECT_EQ(c.hessian[0].verdict, kink > 0 ? Verdict::kKink : Verdict::kAgrees);
    EXPECT_EQ(c.hessian[1].verdict, kink > 0 ? Verdict::kKink : Verdict::kWrong);
    EXPECT_EQ(c.hessian[2].verdict, Verdict::kAgrees);
  }
}

TEST(DerivativeCheck, NoiseIsMeasured) {
  // A rounding error of 1e-7, different at every point, as from an intermediate result in float.
  const auto noise = [](double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    bits = (bits ^ (bits >> 29)) * 0xbf58476d1ce4e5b9ull;
    bits = (bits ^ (bits >> 32)) * 0x94d049bb133111ebull;
    return 1e-7 * (static_cast<double>(bits >> 11) * 0x1p-53 - 0.5);
  };
  const auto f = [&](double x) { return std::sin(3 * x) + noise(x); };
  const DerivativeCheck c = check1(f, 0, 3, 0);
  EXPECT_EQ(c.verdict(), Verdict::kNoise);
  EXPECT_EQ(c.wrong, 0);
  EXPECT_GT(c.noise, 1e-8);
  EXPECT_LT(c.noise, 1e-6);
  // What stands out of the noise is found all the same.
  EXPECT_EQ(check1(f, 0, 3, 5).verdict(), Verdict::kWrong);
}

TEST(DerivativeCheck, BordersAndSingularities) {
  // No room for a step: not judged.
  const double steps[1] = {0};
  const double at[1] = {0};
  const DerivativeCheck none = checkDerivative([](const double* x) { return x[0]; }, at, 1, steps,
                                               {0, {7}, {7}}, kTolerance);
  EXPECT_EQ(none.verdict(), Verdict::kNoise);
  EXPECT_EQ(none.agree, 0);
  // Not defined at the larger steps.
  const auto root = [](double x) { return std::sqrt(1e-4 + x); };
  EXPECT_EQ(check1(root, 1e-2, 50, -250000).verdict(), Verdict::kAgrees);
  EXPECT_FALSE(check1([](double) { return NAN; }, 0, 1, 1).finite);
  EXPECT_FALSE(check1([](double x) { return x; }, 0, INFINITY, 1).finite);
}

TEST(DifferenceSweep, PlainQuotientsConverge) {
  const auto points = sweepEntry(smooth, kAt, 3, 0, 1, 0.25, 1e-2, 8);
  ASSERT_EQ(points.size(), 8u);
  const double exact = exactSmooth().hessian[1];
  EXPECT_EQ(points[0].step, 0.25);
  EXPECT_EQ(points[7].step, 0.25 / 128);
  // Second order, and sixth when extrapolated.
  EXPECT_NEAR((points[4].quotient - exact) / (points[5].quotient - exact), 4, 0.1);
  EXPECT_LT(std::abs(points[4].extrapolated - exact), 1e-4 * std::abs(points[4].quotient - exact));
}

}  // namespace
}  // namespace h2mc::ad
