// SPDX-License-Identifier: MIT
#include "mcmc/populations/luminance_estimate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/core/index.h"

namespace h2mc {

// A multiplexed large step sees one technique where a bootstrap sample sees all. The bootstrap knows both
// variances.
LuminanceEstimate::LuminanceEstimate(const Bootstrap& bootstrap,
                                     const TechniqueDistribution& techniques)
    : bootstrap_(&bootstrap) {
  double multiplexed = 0;
  const std::vector<double> squares = bootstrap.techniqueSquares();
  for (int k = 0; k < techniques.size(); ++k)
    if (techniques.probability(k) > 0) multiplexed += squares[at(k)] / techniques.probability(k);
  const Moments& first = bootstrap.luminance();
  const double spread = std::max(multiplexed - squared(first.mean()), 1e-30);
  weight_ = std::min(1.0, first.variance() / spread);
}

LuminanceEstimate::Value LuminanceEstimate::with(const Moments& largeSteps) const {
  const Moments& first = bootstrap_->luminance();
  const double n0 = static_cast<double>(first.count);
  const double n1 = weight_ * static_cast<double>(largeSteps.count);
  return {(n0 * first.mean() + n1 * largeSteps.mean()) / (n0 + n1),
          std::hypot(n0 * first.standardError(), n1 * largeSteps.standardError()) / (n0 + n1)};
}

nlohmann::json LuminanceEstimate::bootstrapJson() const {
  const Moments& first = bootstrap_->luminance();
  return {{"samples", first.count},
          {"mean luminance", first.mean()},
          {"standard error", first.standardError()},
          {"not finite", bootstrap_->notFinite()}};
}

nlohmann::json LuminanceEstimate::largeStepsJson(const Moments& largeSteps) const {
  return {{"mean luminance", largeSteps.mean()},
          {"standard error", largeSteps.standardError()},
          {"weight", weight_}};
}

}  // namespace h2mc
