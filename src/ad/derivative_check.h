// SPDX-License-Identifier: MIT
// Whether exact derivatives are right: gradient and Hessian held against differences, entry by entry,
// with a verdict that tells a wrong derivative from a difference that cannot judge.
//
// The coordinates of one function may vary on scales from 1 to 1e-6, so errors are measured per
// coordinate: with s_i >= 1, the inverse length on which f varies along i, the error of g_i is relative
// to max(|g_i|, s_i) and that of H_ij to max(|H_ij|, s_i s_j). The s_i are those that bring the largest
// |H_ij| / (s_i s_j) of every row to 1, or as near to it as s_i >= 1 lets them (Ruiz, "A scaling
// algorithm to equilibrate both rows and columns norms in matrices", 2001).
//
// Steps begin at the coordinates' lengths 1 / s_i; that is all that the differences know of what they
// check. An entry whose difference has an estimated error above the tolerance is not judged:
//   kNoise  the error is what f's measured rounding noise makes of the steps, or there is no room for
//           a step at all,
//   kKink   rounding would let the differences converge, but they don't: f isn't smooth there.
// A disagreement beyond the tolerance and ten times the estimated error is looked into by sweeps that
// begin at ever smaller steps, down to where noise would hide it. One that agrees with the exact value
// decides: larger steps had reached beyond what the derivative is about. Otherwise it is kWrong if
// these sweeps agree with one another and converge, and one-sided differences agree (or else kKink);
// where noise leaves no smaller steps to look with, it is kNoise. A Hessian's entry
// is not judged, either, where most of those that share a coordinate with it are not.
#pragma once

#include <cstdint>
#include <vector>

#include "ad/difference_sweep.h"

namespace h2mc::ad {

/// Derivatives as plain numbers.
struct DerivativeValues {
  double value = 0;
  std::vector<double> gradient;
  std::vector<double> hessian;  ///< lower triangle by rows
  bool finite() const;
};

/// In the order of severity: a path is what its worst entry is.
enum class Verdict : std::uint8_t { kAgrees, kNoise, kKink, kWrong };

struct EntryCheck {
  double exact, difference;
  double error;     ///< estimated, of the difference
  double scale;     ///< what errors are relative to
  double relative;  ///< |exact - difference| / scale
  Verdict verdict;
};

struct DerivativeCheck {
  bool finite = false;  ///< the exact derivatives and f(x) are; otherwise nothing else is set
  double value = 0, noise = 0;  ///< f(x), its rounding noise
  double valueError = 0;        ///< |exact value - f(x)|
  std::vector<EntryCheck> gradient, hessian;
  /// Largest relative error of the entries that were judged; 0 where none was.
  double gradientError = 0, hessianError = 0;
  int agree = 0, noisy = 0, kinked = 0, wrong = 0;  ///< entries, by verdict
  Verdict verdict() const;
};

/// Checks `exact`, the derivatives of f at x[0 .. n). `largestStep` as in differenceSweep. tolerance:
/// relative, as above, and absolute for the value itself: f is a logarithm.
DerivativeCheck checkDerivative(const PlainFunction& f, const double* x, int n,
                                const double* largestStep, const DerivativeValues& exact,
                                double tolerance);

/// What errors are relative to: s_i as above, one a coordinate.
std::vector<double> coordinateScales(const DerivativeValues& exact);

}  // namespace h2mc::ad
