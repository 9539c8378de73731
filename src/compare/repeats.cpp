// SPDX-License-Identifier: MIT
#include "compare/repeats.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace h2mc {
namespace {

using Student = boost::math::students_t;

// Degrees of freedom of a difference of means [Welch 1947; Satterthwaite 1946].
double welchDegrees(const SampleMoments& a, const SampleMoments& b) {
  const double va = a.varianceOfMean(), vb = b.varianceOfMean();
  return (va + vb) * (va + vb) / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
}

}  // namespace

SampleMoments sampleMoments(std::span<const double> values) {
  SampleMoments m;
  m.count = static_cast<int>(values.size());
  if (m.count == 0) return m;
  m.mean = std::accumulate(values.begin(), values.end(), 0.0) / m.count;
  if (m.count < 2) return m;
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
  m.variance /= m.count - 1;
  return m;
}

double studentQuantile(double degrees) {
  return boost::math::quantile(Student(degrees), 0.5 + kConfidence / 2);
}

Estimate meanEstimate(std::span<const double> values) {
  const SampleMoments m = sampleMoments(values);
  Estimate result;
  if (m.count == 0) return result;
  result.value = m.mean;
  if (m.count < 2) return result;
  const double half = studentQuantile(m.count - 1) * std::sqrt(m.varianceOfMean());
  result.low = m.mean - half;
  result.high = m.mean + half;
  return result;
}

Estimate geometricMean(std::span<const double> values) {
  std::vector<double> logs;
  logs.reserve(values.size());
  for (const double v : values) logs.push_back(std::log(v));
  const Estimate e = meanEstimate(logs);
  return {std::exp(e.value), std::exp(e.low), std::exp(e.high)};
}

Estimate differenceOfMeans(std::span<const double> a, std::span<const double> b) {
  const SampleMoments ma = sampleMoments(a), mb = sampleMoments(b);
  Estimate result;
  if (ma.count == 0 || mb.count == 0) return result;
  result.value = ma.mean - mb.mean;
  if (ma.count < 2 || mb.count < 2) return result;
  const double variance = ma.varianceOfMean() + mb.varianceOfMean();
  const double half =
      variance > 0 ? studentQuantile(welchDegrees(ma, mb)) * std::sqrt(variance) : 0;
  result.low = result.value - half;
  result.high = result.value + half;
  return result;
}

double welchTest(std::span<const double> a, std::span<const double> b) {
  const SampleMoments ma = sampleMoments(a), mb = sampleMoments(b);
  if (ma.count < 2 || mb.count < 2) return std::numeric_limits<double>::quiet_NaN();
  const double difference = std::abs(ma.mean - mb.mean);
  const double variance = ma.varianceOfMean() + mb.varianceOfMean();
  if (!std::isfinite(difference) || !std::isfinite(variance))
    return std::numeric_limits<double>::quiet_NaN();
  if (variance == 0) return difference == 0 ? 1 : 0;
  const Student t(welchDegrees(ma, mb));
  return 2 * boost::math::cdf(boost::math::complement(t, difference / std::sqrt(variance)));
}

std::vector<double> holmAdjusted(std::span<const double> pValues) {
  std::vector<double> adjusted(pValues.begin(), pValues.end());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < adjusted.size(); ++i)
    if (!std::isnan(adjusted[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return pValues[i] < pValues[j]; });
  double largest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    largest = std::max(largest, pValues[order[k]] * static_cast<double>(order.size() - k));
    adjusted[order[k]] = std::min(1.0, largest);
  }
  return adjusted;
}

}  // namespace h2mc
