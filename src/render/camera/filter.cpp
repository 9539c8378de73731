// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "render/camera/film_settings.h"

namespace h2mc {
namespace {

// [Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", eq. 8], x in [0, 2).
float mitchell(float x, float b, float c) {
  const float x2 = x * x;
  if (x < 1) return ((12 - 9 * b - 6 * c) * x2 * x + (-18 + 12 * b + 6 * c) * x2 + 6 - 2 * b) / 6;
  return ((-b - 6 * c) * x2 * x + (6 * b + 30 * c) * x2 + (-12 * b - 48 * c) * x + 8 * b + 24 * c) /
         6;
}

}  // namespace

float Filter::evaluate(float x) const {
  x = std::abs(x);
  if (x > radius) return 0;
  switch (kind) {
    case Kind::kBox:
      return 1;
    case Kind::kTent:
      return 1 - x / radius;
    case Kind::kGaussian: {
      // Lowered so that it reaches zero at the radius.
      const float a = -1 / (2 * stddev * stddev);
      return std::max(0.f, std::exp(a * x * x) - std::exp(a * radius * radius));
    }
    case Kind::kMitchell:
      return x < radius ? mitchell(2 * x / radius, b, c) : 0.f;
  }
  return 0;
}

}  // namespace h2mc
