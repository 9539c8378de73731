// SPDX-License-Identifier: MIT
#include "render/integrator/sample_tally.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace h2mc {

void SampleTally::add(const SampleTally& other) {
  luminance += other.luminance;
  squares += other.squares;
  samples += other.samples;
  notFinite += other.notFinite;
}

double SampleTally::meanLuminance() const {
  return samples > 0 ? luminance / static_cast<double>(samples) : 0;
}

double SampleTally::meanLuminanceError() const {
  if (samples == 0) return 0;
  const double n = static_cast<double>(samples), mean = meanLuminance();
  return std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
}

void PassTally::end(const SampleTally& all, double samples) {
  const double mean = (all.luminance - before) / samples;
  luminance += mean;
  squares += mean * mean;
  ++passes;
  before = all.luminance;
}

double PassTally::error() const {
  if (passes < 2) return std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(passes), mean = luminance / n;
  return std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1));
}

}  // namespace h2mc
