// SPDX-License-Identifier: MIT
// How far a symmetric step goes along a coordinate.
#pragma once

#include <cmath>

#include "render/core/random.h"
#include "render/scene/option_set.h"

namespace h2mc {

enum class StepShape {
  kGaussian,  // normal with standard deviation sigma
  kKelemen,   // exponential between 1/1024 and 1/64 [Kelemen et al. 2002]
};

inline float stepOffset(StepShape shape, float sigma, Random& random) {
  if (shape == StepShape::kGaussian) return sigma * random.normal();
  constexpr float kSmallest = 1.f / 1024, kLargest = 1.f / 64;
  const float step = kLargest * std::exp(-std::log(kLargest / kSmallest) * random.uniform());
  return random.next() & 1 ? step : -step;
}

// The parameter smallStep, with this fallback, and its value.
constexpr Parameter smallStepParameter(std::string_view fallback) {
  return {"smallStep", ParameterType::kString, fallback, "shape of the isotropic step",
          "gaussian|kelemen"};
}
inline StepShape smallStep(const OptionSet& options) {
  return options.string("smallStep") == "kelemen" ? StepShape::kKelemen : StepShape::kGaussian;
}

}  // namespace h2mc
