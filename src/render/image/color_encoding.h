// SPDX-License-Identifier: MIT
// The sRGB transfer curve (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace h2mc {

inline float srgbToLinear(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

inline float linearToSrgb(float v) {
  return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

}  // namespace h2mc
