// SPDX-License-Identifier: MIT
// Finite differences that know their own error, for functions whose coordinates vary on very
// different scales: every coordinate gets steps of its own, from a sweep along its axis.
//
// Central differences at steps that halve, extrapolated to step 0 in powers of the step's square
// (Ridders, "Accurate computation of F'(x) and F'(x) F''(x)", 1982). The function's rounding noise is
// measured, not assumed, by a difference table (Moré and Wild, "Estimating computational noise",
// 2011, section 3). Steps are powers of two, or all of them times `stretch`: x + h is then exact for
// x that came from a float.
#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace h2mc::ad {

/// A function of n numbers; may return NaN or an infinity where it is not defined.
using PlainFunction = std::function<double(const double*)>;

/// An extrapolated difference quotient.
struct Difference {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::infinity();  ///< estimate: truncation or noise
  double noise = std::numeric_limits<double>::infinity();  ///< what f's rounding makes of it
};

/// Index of entry (i, j) in a lower triangle stored by rows.
constexpr int triangleIndex(int i, int j) {
  return i < j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j;
}

struct DifferenceSweep {
  double value = 0;  ///< f(x)
  double noise = 0;  ///< standard deviation of f's rounding error, along the worst axis
  std::vector<Difference> gradient;
  std::vector<Difference> hessian;  ///< lower triangle by rows
};

/// The gradient and Hessian of f at x[0 .. n). `largestStep` bounds the step along each axis (0: this
/// coordinate can't move; its entries stay NaN). `stretch` in [0.5, 1] scales all steps: sweeps with
/// different ones share no evaluation but f(x). About 8 n^2 calls of f.
DifferenceSweep differenceSweep(const PlainFunction& f, const double* x, int n,
                                const double* largestStep, double stretch = 1);

/// One entry's plain quotients against step size, to look at: column 0 is the step along `i`, column
/// 1 the central quotient there, column 2 its extrapolation from this step and the next two larger
/// ones. First derivative by i if j < 0, else the second by i and j (whose step is `ratio` times i's).
struct SweepPoint {
  double step, quotient, extrapolated;
};
std::vector<SweepPoint> sweepEntry(const PlainFunction& f, const double* x, int n, int i, int j,
                                   double largestStep, double ratio, int levels);

/// Whether f has a kink at x itself: its one-sided first or second derivatives along x + s * direction,
/// s > 0 and s < 0, differ by more than `scale` (per unit of s) at steps from |s| = 3 down to where
/// `noise`, f's, hides it.
bool kinkAt(const PlainFunction& f, const double* x, int n, const double* direction, double noise,
            double scale);

}  // namespace h2mc::ad
