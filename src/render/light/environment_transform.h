// SPDX-License-Identifier: MIT
// What a transform does to lights that are infinitely far.
#pragma once

#include "render/image/image.h"

namespace h2mc {

class Properties;

// What it does to directions: M = rotation * stretch, with a rotation (perhaps a reflection too) and a symmetric
// stretch, whose scale as a whole does not matter.
struct EnvironmentTransform {
  glm::dmat3 rotation{1}, stretch{1};
  bool stretches = false;

  glm::dmat3 matrix() const { return rotation * stretch; }
};

// Of the parameter "toWorld". Fails if it can't be inverted, warns if it stretches.
EnvironmentTransform environmentTransform(const Properties& properties);

// A picture in latitude and longitude as a rotation alone has to see it: at direction d it has what the original has at
// stretch^-1 d.
Image stretched(const Image& image, const glm::dmat3& stretch);

}  // namespace h2mc
