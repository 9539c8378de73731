// Which light a path starts from.
#pragma once

#include <vector>

namespace h2mc {

// Chooses a light by power. Probabilities are positive for every light that emits.
class LightPicker {
 public:
  LightPicker() = default;
  // powers: finite, not negative, one a light.
  explicit LightPicker(const std::vector<double>& powers);

  struct Choice {
    int light;        // -1 when there is no light
    float remainder;  // the coordinate within the light's interval, in [0, 1): uniform again
  };
  Choice choose(float coordinate) const;
  float probability(int light) const { return probabilities_[light]; }
  // A coordinate that chooses `light` with this remainder.
  float invert(int light, float remainder) const;

 private:
  std::vector<float> probabilities_;
  std::vector<double> cumulative_;
};

}  // namespace h2mc
