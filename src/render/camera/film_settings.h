// SPDX-License-Identifier: MIT
// The film: how large the image is and how samples are filtered into pixels.
#pragma once

#include "render/core/types.h"

namespace h2mc {

// Reconstruction filters, separable, centred on the pixel [Mitsuba 0.6's definitions and defaults].
struct Filter {
  enum class Kind { kBox, kTent, kGaussian, kMitchell };
  // Radii in pixels. A narrower filter would leave part of the film in no pixel.
  static constexpr float kNarrowest = 0.5f, kWidest = 32;
  static constexpr float kDeviations = 4;  // of a Gaussian, that its radius spans

  Kind kind = Kind::kBox;
  float radius = 0.5f;             // box 0.5, tent 1, gaussian kDeviations * stddev, mitchell 2
  float stddev = 0.5f;             // gaussian
  float b = 1.f / 3, c = 1.f / 3;  // mitchell

  float evaluate(float x) const;  // one dimension, x in pixels; not normalised; 0 beyond the radius
};

struct FilmSettings {
  int width = 768;
  int height = 576;
  Filter filter;
};

}  // namespace h2mc
