// SPDX-License-Identifier: MIT
// Symmetric steps of the same size in all coordinates of a technique's primary space.
#pragma once

#include "mcmc/mutations/mutations.h"

namespace h2mc {

// How far an isotropic step goes in each coordinate.
enum class StepShape {
  kGaussian,  // normal with standard deviation sigma
  kKelemen,   // exponential between 1/1024 and 1/64 [Kelemen et al. 2002]
};

// All coordinates move, discrete choices and time included, and wrap, which is symmetric whatever the target does at
// the borders; but for time, which is reflected there.
class IsotropicStep final : public Mutation {
 public:
  // Keeps a reference.
  IsotropicStep(const Target& target, StepShape shape, float sigma)
      : target_(target), shape_(shape), sigma_(sigma) {}
  std::string_view name() const override { return "isotropic"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;

 private:
  float offset(Random& random) const;

  const Target& target_;
  StepShape shape_;
  float sigma_;
};

// By the options sigma and smallStep.
MutationPlugin isotropicStep();

}  // namespace h2mc
