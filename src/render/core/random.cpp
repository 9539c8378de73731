// SPDX-License-Identifier: MIT
#include "render/core/random.h"

#include <cmath>
#include <numbers>

namespace h2mc {

float Random::normal() {
  if (hasSpare_) {
    hasSpare_ = false;
    return spare_;
  }
  // 1 - u is in (0, 1], so the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniformDouble()));
  const double angle = 2.0 * std::numbers::pi * uniformDouble();
  spare_ = static_cast<float>(radius * std::sin(angle));
  hasSpare_ = true;
  return static_cast<float>(radius * std::cos(angle));
}

}  // namespace h2mc
