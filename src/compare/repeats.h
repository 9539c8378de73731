// SPDX-License-Identifier: MIT
// What a few independent repeats say: intervals and tests by Student's t distribution.
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace h2mc {

inline constexpr double kConfidence = 0.95;

// A value with the interval that holds the truth with a probability of kConfidence. Without one
// (a single repeat) low and high are not numbers; unbounded ends are infinite.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

// Sample mean and variance (n - 1).
struct SampleMoments {
  double mean = 0, variance = 0;
  int count = 0;
  double varianceOfMean() const { return count > 0 ? variance / count : 0; }
};
SampleMoments sampleMoments(std::span<const double> values);

// The t of the two-sided interval: P(|T| <= t) = kConfidence. Precondition: degrees > 0.
double studentQuantile(double degrees);

// Mean of normally distributed values.
Estimate meanEstimate(std::span<const double> values);

// Geometric mean of positive values whose logarithms are normally distributed.
Estimate geometricMean(std::span<const double> values);

// Difference of the means, a - b, of two samples of different variance [Welch 1947].
Estimate differenceOfMeans(std::span<const double> a, std::span<const double> b);

// Probability of means as far apart, or further, if the true ones are equal (Welch's test, two-sided).
// Not a number where a sample has less than two values; 0 or 1 where neither varies.
double welchTest(std::span<const double> a, std::span<const double> b);

// P values of several tests so that the chance of any false alarm stays below the level they are
// compared with [Holm 1979]. Those that are not numbers stay so and are not counted.
std::vector<double> holmAdjusted(std::span<const double> pValues);

}  // namespace h2mc
