// SPDX-License-Identifier: MIT
// Which light a path starts from.
#pragma once

#include <vector>

#include "render/core/distribution.h"
#include "render/core/index.h"

namespace h2mc {

// Chooses a light with fixed probabilities.
class LightPicker {
 public:
  LightPicker() = default;
  // weights: finite, not negative, one a light. All zero counts as all equal.
  explicit LightPicker(const std::vector<double>& weights);

  struct Choice {
    int light;        // -1 when there is no light
    float remainder;  // the coordinate within the light's interval, in [0, 1): uniform again
  };
  Choice choose(float coordinate) const;
  float probability(int light) const { return probabilities_[at(light)]; }
  // A coordinate that chooses `light` with this remainder, as near as floats allow; -1 where the
  // light is so weak that no float in [0, 1) chooses it.
  float invert(int light, float remainder) const;

 private:
  std::vector<float> probabilities_;
  DiscreteDistribution distribution_;
};

}  // namespace h2mc
