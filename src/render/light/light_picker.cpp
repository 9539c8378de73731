// SPDX-License-Identifier: MIT
#include "render/light/light_picker.h"

namespace h2mc {

LightPicker::LightPicker(const std::vector<double>& weights) : distribution_(weights) {
  for (int i = 0; i < distribution_.size(); ++i)
    probabilities_.push_back(static_cast<float>(distribution_.probability(i)));
}

LightPicker::Choice LightPicker::choose(float coordinate) const {
  if (probabilities_.empty()) return {-1, 0};
  const DiscreteDistribution::Sample sample = distribution_.sample(coordinate);
  return {sample.index, sample.remainder};
}

float LightPicker::invert(int light, float remainder) const {
  return distribution_.invert(light, remainder);
}

}  // namespace h2mc
