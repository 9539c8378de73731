// SPDX-License-Identifier: MIT
// Does a sampling routine draw directions with the density it says? Pearson's chi-square test over a
// grid of cells on the sphere, after pbrt-v4's and Mitsuba's tests of the same.
//
//   DirectionHistogram cells(axis);
//   for (...) cells.add(sampledDirection);     // cells.addNothing() for a draw without a direction
//   const auto verdict = cells.test([&](const Vec3<double>& w) { return pdf(w); }, kTests);
//   EXPECT_TRUE(verdict.passed) << verdict.message;
//
// The density may integrate to less than 1: the rest must be draws without a direction.
//
// False alarms: a whole family of `tests` verdicts on correct routines fails somewhere with
// probability kFalseAlarmRate (Sidak's correction); seeds are fixed, so a test that passes once
// passes always.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "render/core/frame.h"
#include "render/core/index.h"

namespace h2mc::test {

inline constexpr double kFalseAlarmRate = 1e-3;

// The significance of one test of `tests` that together raise a false alarm with `rate`.
inline double sidak(double rate, int tests) { return -std::expm1(std::log1p(-rate) / tests); }

// P(X >= x) for a chi-square variable: the regularised upper incomplete gamma function, by its
// series or its continued fraction (Lentz).
inline double chiSquareTail(double x, double degrees) {
  const double a = 0.5 * degrees, y = 0.5 * x;
  if (!(y > 0)) return 1;
  const double front = std::exp(a * std::log(y) - y - std::lgamma(a));
  if (y < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-16; ++n) sum += term *= y / (a + n);
    return 1 - front * sum;
  }
  double b = y + 1 - a, c = 1e300, d = 1 / b, f = d;
  for (int n = 1; n < 10000; ++n) {
    const double k = -n * (n - a);
    b += 2;
    d = 1 / (k * d + b);
    c = b + k / c;
    f *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * f;
}

struct ChiSquareVerdict {
  bool passed = false;
  double statistic = 0, pValue = 0;
  int degrees = 0;
  std::string message;
};

// Compares counts. Cells expected to hold fewer than 5 are pooled; a count in a cell whose
// expectation is 0 fails outright. The expectations sum to the number of draws.
inline ChiSquareVerdict chiSquareTest(const std::vector<double>& observed,
                                      const std::vector<double>& expected, int tests) {
  ChiSquareVerdict v;
  std::ostringstream message;
  std::vector<std::size_t> order(expected.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  double pooledObserved = 0, pooledExpected = 0, worst = 0;
  std::size_t worstCell = 0;
  int cells = 0;
  bool impossible = false;
  const auto close = [&](double o, double e, std::size_t cell) {
    const double term = (o - e) * (o - e) / e;
    v.statistic += term;
    ++cells;
    if (term > worst) worst = term, worstCell = cell;
  };
  for (const std::size_t i : order) {
    if (!(expected[i] > 0)) {
      // Rounding at the edge of a lobe's support may put a stray sample into its neighbour.
      if (observed[i] > 1) {
        impossible = true;
        message << observed[i] << " draws in cell " << i << ", where the density is 0; ";
      }
    } else if (expected[i] < 5) {
      pooledObserved += observed[i];
      pooledExpected += expected[i];
    } else {
      if (pooledExpected > 0 && pooledExpected < 5) {
        pooledObserved += observed[i];
        pooledExpected += expected[i];
      } else {
        close(observed[i], expected[i], i);
      }
    }
  }
  if (pooledExpected > 0) close(pooledObserved, pooledExpected, expected.size());
  v.degrees = cells - 1;
  v.pValue = v.degrees > 0 ? chiSquareTail(v.statistic, v.degrees) : 1;
  v.passed = !impossible && v.pValue >= sidak(kFalseAlarmRate, tests);
  message << "chi-square " << v.statistic << " at " << v.degrees
          << " degrees of freedom, p = " << v.pValue << "; worst cell " << worstCell << " of "
          << expected.size();
  if (worstCell < expected.size())
    message << ": " << observed[worstCell] << " draws, expected " << expected[worstCell];
  v.message = message.str();
  return v;
}

// A grid of rings around an axis, finer towards it, each cut into sectors.
class DirectionHistogram {
 public:
  using Density = std::function<double(const Vec3<double>&)>;

  explicit DirectionHistogram(const Vec3<double>& axis, int rings = 14, int sectors = 12)
      : frame_(Frame<double>::fromNormal(glm::normalize(axis))),
        rings_(rings),
        sectors_(sectors),
        counts_(static_cast<std::size_t>(rings) * sectors) {}

  template <class S>
  void add(const Vec3<S>& direction) {
    const Vec3<double> w = frame_.toLocal(glm::normalize(Vec3<double>(direction)));
    const double theta = std::atan2(std::hypot(w.x, w.y), w.z);
    const double phi = std::atan2(w.y, w.x) / (2 * std::numbers::pi);
    const int ring = static_cast<int>(rings_ * std::sqrt(theta / std::numbers::pi));
    const int sector = static_cast<int>((phi < 0 ? phi + 1 : phi) * sectors_);
    ++counts_[at(std::min(ring, rings_ - 1)) * sectors_ +
              static_cast<std::size_t>(std::min(sector, sectors_ - 1))];
    ++draws_;
  }
  void addNothing() { ++draws_; }

  // `tests`: how many verdicts this is one of.
  ChiSquareVerdict test(const Density& density, int tests) const {
    std::vector<double> observed = counts_, expected;
    double sum = 0, total = 0;
    for (int i = 0; i < rings_; ++i)
      for (int j = 0; j < sectors_; ++j) {
        const double mass =
            integral(density, ringEdge(i), ringEdge(i + 1), sectorEdge(j), sectorEdge(j + 1));
        expected.push_back(mass * draws_);
        sum += mass;
        total += counts_[expected.size() - 1];
      }
    if (sum > 1 + 2e-4) {
      ChiSquareVerdict v;
      v.message = "the density integrates to " + std::to_string(sum);
      return v;
    }
    observed.push_back(draws_ - total);
    const double nothing = (1 - sum) * draws_;
    expected.push_back(nothing > 1e-3 * std::sqrt(draws_) ? nothing : 0);
    return chiSquareTest(observed, expected, tests);
  }

  // The integral of the density over the sphere.
  double integral(const Density& density) const {
    double sum = 0;
    for (int i = 0; i < rings_; ++i)
      for (int j = 0; j < sectors_; ++j)
        sum += integral(density, ringEdge(i), ringEdge(i + 1), sectorEdge(j), sectorEdge(j + 1));
    return sum;
  }

 private:
  double ringEdge(int i) const {
    const double t = double(i) / rings_;
    return std::numbers::pi * t * t;
  }
  double sectorEdge(int j) const { return 2 * std::numbers::pi * j / sectors_; }

  // Gauss-Legendre with 4 x 4 nodes over theta and phi.
  double rule(const Density& density, double t0, double t1, double p0, double p1) const {
    static constexpr double x[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                   0.9305681557970262};
    static constexpr double w[] = {0.17392742256872692, 0.32607257743127305, 0.32607257743127305,
                                   0.17392742256872692};
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const double theta = t0 + (t1 - t0) * x[i], s = std::sin(theta), c = std::cos(theta);
      for (int j = 0; j < 4; ++j) {
        const double phi = p0 + (p1 - p0) * x[j];
        sum += w[i] * w[j] * s * density(frame_.toWorld({s * std::cos(phi), s * std::sin(phi), c}));
      }
    }
    return sum * (t1 - t0) * (p1 - p0);
  }
  double integral(const Density& density, double t0, double t1, double p0, double p1) const {
    return refine(density, t0, t1, p0, p1, rule(density, t0, t1, p0, p1), 1e-6, 0);
  }
  double refine(const Density& density, double t0, double t1, double p0, double p1, double whole,
                double tolerance, int depth) const {
    const double t = 0.5 * (t0 + t1), p = 0.5 * (p0 + p1);
    const double a = rule(density, t0, t, p0, p), b = rule(density, t0, t, p, p1);
    const double c = rule(density, t, t1, p0, p), d = rule(density, t, t1, p, p1);
    const double sum = a + b + c + d;
    if (depth == 7 || (depth > 1 && std::abs(sum - whole) < tolerance)) return sum;
    tolerance *= 0.5;
    return refine(density, t0, t, p0, p, a, tolerance, depth + 1) +
           refine(density, t0, t, p, p1, b, tolerance, depth + 1) +
           refine(density, t, t1, p0, p, c, tolerance, depth + 1) +
           refine(density, t, t1, p, p1, d, tolerance, depth + 1);
  }

  Frame<double> frame_;
  int rings_, sectors_;
  std::vector<double> counts_;
  double draws_ = 0;
};

}  // namespace h2mc::test
