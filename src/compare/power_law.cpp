// SPDX-License-Identifier: MIT
#include "compare/power_law.h"

#include <cmath>
#include <limits>

namespace h2mc {

double PowerLaw::logError(double t) const { return logC - p * std::log(t); }

double PowerLaw::timeFor(double logError) const {
  return p > 0 ? std::exp((logC - logError) / p) : std::numeric_limits<double>::infinity();
}

PowerLaw fitPowerLaw(std::span<const TimedError> points) {
  PowerLaw law;
  double meanX = 0, meanY = 0;
  const double n = static_cast<double>(points.size());
  for (const TimedError& point : points) {
    const double x = std::log(point.t), y = std::log(point.error);
    if (!std::isfinite(x) || !std::isfinite(y)) return law;
    meanX += x / n;
    meanY += y / n;
  }
  double xx = 0, xy = 0;
  for (const TimedError& point : points) {
    const double x = std::log(point.t) - meanX;
    xx += x * x;
    xy += x * (std::log(point.error) - meanY);
  }
  if (!(xx > 1e-6 * n)) return law;  // all at one time
  law.p = -xy / xx;
  law.logC = meanY + law.p * meanX;
  law.valid = true;
  return law;
}

}  // namespace h2mc
