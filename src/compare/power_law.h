// SPDX-License-Identifier: MIT
// error = c t^-p
#pragma once

#include <span>

namespace h2mc {

// A straight line in the plane of logarithms. p is 1 for the variance of independent samples and for
// squared errors, 1/2 for absolute ones.
struct PowerLaw {
  double logC = 0, p = 0;
  bool valid = false;

  double logError(double t) const;
  // Where the error falls to exp(logError); infinite where it does not fall.
  double timeFor(double logError) const;
};

struct TimedError {
  double t, error;
};

// Least squares of the errors' logarithms. Not valid with less than two different times or with an
// error or time that is not positive and finite.
PowerLaw fitPowerLaw(std::span<const TimedError> points);

}  // namespace h2mc
