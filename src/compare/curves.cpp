// SPDX-License-Identifier: MIT
#include "compare/curves.h"

#include <algorithm>

namespace h2mc {

MethodCurve methodCurve(const MethodRuns& method, const std::string& metric, bool timed) {
  MethodCurve curve;
  std::size_t marks = 0;
  for (const Repeat& repeat : method.repeats) marks = std::max(marks, repeat.points.size());
  for (std::size_t k = 0; k < marks; ++k) {
    std::vector<double> errors, seconds, perPixel;
    for (const Repeat& repeat : method.repeats) {
      if (k >= repeat.points.size()) continue;
      errors.push_back(repeat.points[k].errors.at(metric));
      seconds.push_back(repeat.points[k].seconds);
      perPixel.push_back(repeat.points[k].perPixel);
    }
    CurvePoint point;
    point.seconds = geometricMean(seconds).value;
    point.perPixel = geometricMean(perPixel).value;
    point.position = timed ? point.seconds : point.perPixel;
    point.error = geometricMean(errors);
    point.bandIsRange = std::ssize(errors) < kLeastForBands;
    if (!point.bandIsRange) {
      point.bandLow = point.error.low;
      point.bandHigh = point.error.high;
    } else if (errors.size() > 1) {
      const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
      point.bandLow = *low;
      point.bandHigh = *high;
    }
    curve.push_back(point);
  }
  return curve;
}

}  // namespace h2mc
