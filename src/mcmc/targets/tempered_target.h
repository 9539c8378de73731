// SPDX-License-Identifier: MIT
// Luminance to a power: flatter than luminance itself.
#pragma once

#include <cmath>

#include "mcmc/targets/target.h"

namespace h2mc {

// mean (luminance / mean)^power, 0 < power <= 1, without any importance map. The mean only keeps it within float.
class TemperedTarget final : public PathTarget {
 public:
  TemperedTarget(const Scene& scene, int maxLength, double power, double mean)
      : PathTarget(scene, maxLength), power_(power), mean_(mean) {}
  double power() const { return power_; }

  double value(const Technique&, const Rgbf& contribution, float, float) const override {
    const double y = luminance(contribution);
    return y > 0 ? mean_ * std::pow(y / mean_, power_) : 0;
  }
  void differentiate(const Path& path, Derivative& result) const override {
    PathTarget::differentiate(path, result);
    const auto power = static_cast<float>(power_);
    const int n = result.dimension;
    for (int i = 0; i < n; ++i) result.gradient[i] *= power;
    for (int i = 0; i < n * (n + 1) / 2; ++i) result.hessian[i] *= power;
  }
  void differentiateOnce(const Path& path, Gradient& result) const override {
    PathTarget::differentiateOnce(path, result);
    for (int i = 0; i < result.dimension; ++i) result.gradient[i] *= static_cast<float>(power_);
  }

 private:
  double power_, mean_;
};

}  // namespace h2mc
