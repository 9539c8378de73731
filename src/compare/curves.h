// SPDX-License-Identifier: MIT
// A method's error along its marks.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/repeats.h"

namespace h2mc {

// Below this many repeats the 95 % interval is so wide (of two: nine standard deviations of the logarithms to both
// sides) that it says nothing in a plot.
inline constexpr int kLeastForBands = 3;

// The images of one mark in all repeats. Times and errors are geometric means.
struct CurvePoint {
  double seconds = 0, perPixel = 0;
  double position = 0;  // one of these
  Estimate error;
  // What is drawn around the error: its interval or, of fewer repeats than kLeastForBands, from the smallest to the
  // largest; not numbers for a single one.
  double bandLow = std::numeric_limits<double>::quiet_NaN();
  double bandHigh = std::numeric_limits<double>::quiet_NaN();
  bool bandIsRange = false;
};
using MethodCurve = std::vector<CurvePoint>;

// timed: positions are seconds, else mutations (samples) a pixel. Precondition: measured.
MethodCurve methodCurve(const MethodRuns& method, const std::string& metric, bool timed);

}  // namespace h2mc
