// SPDX-License-Identifier: MIT
// How bright the picture is.
#pragma once

#include "mcmc/chain/statistics.h"
#include "mcmc/mutations/technique_distribution.h"
#include "mcmc/populations/bootstrap.h"

namespace h2mc {

// The mean luminance of the film: bootstrap samples and large steps both estimate it without bias.
class LuminanceEstimate {
 public:
  // Keeps a reference to the bootstrap. Large steps that see all techniques count as much as its samples.
  explicit LuminanceEstimate(const Bootstrap& bootstrap) : bootstrap_(&bootstrap) {}
  // Large steps that draw one technique from these.
  LuminanceEstimate(const Bootstrap& bootstrap, const TechniqueDistribution& techniques);

  struct Value {
    double mean, error;  // standard error of the mean
  };
  // With the large steps made so far.
  Value with(const Moments& largeSteps) const;
  // Bootstrap and large steps as they are told.
  nlohmann::json bootstrapJson() const;
  nlohmann::json largeStepsJson(const Moments& largeSteps) const;

 private:
  const Bootstrap* bootstrap_;
  double weight_ = 1;  // of a large step against a bootstrap sample
};

}  // namespace h2mc
