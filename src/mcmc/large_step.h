// Large steps: a technique and a primary sample independent of the state.
#pragma once

#include "mcmc/mutation.h"
#include "mcmc/technique_distribution.h"

namespace h2mc {

class LargeStep final : public Mutation {
 public:
  // Keeps references.
  LargeStep(const Target& target, const TechniqueDistribution& techniques)
      : target_(target), techniques_(techniques) {}
  std::string_view name() const override { return "large"; }
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;

  // target / density of the last proposal, zero if it was dark: its mean is the integral of the
  // target, the film's mean luminance.
  double lastEstimate() const { return lastEstimate_; }

 private:
  const Target& target_;
  const TechniqueDistribution& techniques_;
  double lastEstimate_ = 0;
};

}  // namespace h2mc
