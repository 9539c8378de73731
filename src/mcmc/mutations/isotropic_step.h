// SPDX-License-Identifier: MIT
// Symmetric steps of the same size in all coordinates of a technique's primary space.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/step_shape.h"
#include "mcmc/mutations/step_sizes.h"

namespace h2mc {

// All coordinates move, discrete choices and time included, and wrap, which is symmetric whatever the target does at
// the borders; but for time and the aperture's, which are reflected there unless `sharedWraps`.
class IsotropicStep final : public Mutation {
 public:
  // Keeps a reference.
  IsotropicStep(const Target& target, StepShape shape, float sigma, double targetAcceptance = 0,
                bool sharedWraps = false)
      : target_(target),
        shape_(shape),
        sigma_(sigma),
        sizes_(targetAcceptance),
        sharedWraps_(sharedWraps) {}
  std::string_view name() const override { return "isotropic"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  void learn(const ChainStatistics& statistics, std::size_t kind) override {
    sizes_.learn(statistics.acceptance[kind]);
  }
  void archive(Archive& archive) override { sizes_.archive(archive); }

 private:
  float offset(Random& random) const { return stepOffset(shape_, sigma_, random); }

  const Target& target_;
  StepShape shape_;
  float sigma_;
  StepSizes sizes_;
  bool sharedWraps_;
};

// By the options sigma and smallStep.
MutationPlugin isotropicStep();

}  // namespace h2mc
