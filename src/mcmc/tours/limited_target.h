// SPDX-License-Identifier: MIT
// Luminance up to a limit.
#pragma once

#include <algorithm>

#include "mcmc/targets/target.h"

namespace h2mc {

// The luminance of a path's contribution, or `limit` where that is less. What is splatted is divided by it, so that the
// picture's mean does not depend on the limit; but no path begins more tours than one of that brightness, which would
// keep a thread for minutes, and chains walk freely over what is brighter.
// Its derivatives are those of the luminance.
class LimitedTarget final : public PathTarget {
 public:
  LimitedTarget(const Scene& scene, int maxLength, double limit)
      : PathTarget(scene, maxLength), limit_(limit) {}
  double value(const Technique&, const Rgbf& contribution, float, float) const override {
    return std::min(double(luminance(contribution)), limit_);
  }

 private:
  double limit_;
};

}  // namespace h2mc
