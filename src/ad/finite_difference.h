// SPDX-License-Identifier: MIT
// Gradients and Hessians by central differences, to hold exact derivatives against.
//
// Each entry is a sweep of difference quotients with shrinking steps, extrapolated to step 0 by
// polynomials in the step's square, of which the entry with the smallest estimated error is taken
// (Ridders, "Accurate computation of F'(x) and F'(x) F''(x)", 1982).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace h2mc::ad {

/// A number and an estimate of its error; both NaN where nothing could be estimated.
template <class R>
struct Estimate {
  R value = std::numeric_limits<R>::quiet_NaN();
  R error = std::numeric_limits<R>::quiet_NaN();
};

/// The limit at 0 of quotient(step), a function of step with an expansion in step^2, from `levels`
/// steps that begin at `step` and shrink by 1.6. Steps where the quotient is not finite are left
/// out. noise(step) is the rounding error of the quotient, a lower bound of the error.
template <class R, class Quotient, class Noise>
Estimate<R> extrapolate(Quotient&& quotient, Noise&& noise, R step, int levels) {
  constexpr R kShrink = R(1.6);
  Estimate<R> best;
  std::vector<R> previous, row;
  for (int level = 0; level < levels; ++level, step /= kShrink) {
    row.assign(1, quotient(step));
    if (!std::isfinite(row[0])) {
      previous.clear();
      continue;
    }
    R factor = 1;
    for (std::size_t i = 0; i < previous.size(); ++i) {
      factor *= kShrink * kShrink;
      row.push_back((row[i] * factor - previous[i]) / (factor - 1));
      const R error = std::max(
          {std::abs(row[i + 1] - row[i]), std::abs(row[i + 1] - previous[i]), noise(step)});
      if (!(error >= best.error)) best = {row[i + 1], error};
    }
    previous.swap(row);
  }
  return best;
}

template <class R>
struct FiniteDifferences {
  R value;                            ///< f(x)
  std::vector<Estimate<R>> gradient;  ///< n entries
  std::vector<Estimate<R>> hessian;   ///< n x n entries, symmetric
};

/// The derivatives at x[0 .. n) of f, a function of an R* to n numbers that returns an R; f is
/// called some 25 n^2 times within `step` of x in each coordinate, and may return NaN where it is
/// not defined. R is double or long double.
template <class R, class F>
FiniteDifferences<R> finiteDifferences(F&& f, const R* x, int n, R step = R(0.05),
                                       int levels = 12) {
  std::vector<R> at(x, x + n);
  FiniteDifferences<R> result;
  result.value = f(at.data());
  const R center = result.value;
  const R rounding = 4 * std::numeric_limits<R>::epsilon() *
                     std::max(std::abs(center), std::numeric_limits<R>::min());
  result.gradient.resize(n);
  result.hessian.resize(std::size_t(n) * n);
  const auto moved = [&](int i, R di, int j, R dj) {
    at[i] += di;
    at[j] += dj;
    const R y = f(at.data());
    at[i] = x[i];
    at[j] = x[j];
    return y;
  };
  const auto firstNoise = [&](R h) { return rounding / h; };
  const auto secondNoise = [&](R h) { return rounding / (h * h); };
  for (int i = 0; i < n; ++i) {
    result.gradient[i] =
        extrapolate<R>([&](R h) { return (moved(i, h, i, 0) - moved(i, -h, i, 0)) / (2 * h); },
                       firstNoise, step, levels);
    result.hessian[i * n + i] = extrapolate<R>(
        [&](R h) { return (moved(i, h, i, 0) - 2 * center + moved(i, -h, i, 0)) / (h * h); },
        secondNoise, step, levels);
    for (int j = 0; j < i; ++j)
      result.hessian[i * n + j] = result.hessian[j * n + i] = extrapolate<R>(
          [&](R h) {
            return (moved(i, h, j, h) - moved(i, h, j, -h) - moved(i, -h, j, h) +
                    moved(i, -h, j, -h)) /
                   (4 * h * h);
          },
          secondNoise, step, levels);
  }
  return result;
}

}  // namespace h2mc::ad
