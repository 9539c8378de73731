// SPDX-License-Identifier: MIT
// Numbers in [0, 1), which rounding must not move to 1.
#pragma once

#include <algorithm>
#include <cmath>

namespace h2mc {

// The largest float below 1.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

// The number in [0, 1) nearest to u.
inline float toUnitInterval(double u) { return std::clamp(static_cast<float>(u), 0.f, kBelowOne); }

// x modulo 1, in [0, 1) even where rounding would give 1.
inline float wrap(float x) {
  const float y = x - std::floor(x);
  return y < 1 ? y : 0;
}

// x reflected at 0 and at 1, as often as it takes.
inline float reflect(float x) {
  const float y = std::abs(x) - 2 * std::floor(std::abs(x) / 2);
  return std::min(y < 1 ? y : 2 - y, kBelowOne);
}

}  // namespace h2mc
