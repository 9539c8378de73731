// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/technique_distribution.h"

namespace h2mc {

// One technique, drawn from fixed probabilities, at a uniform sample [Hachisuka et al. 2014].
class MultiplexedLargeStep final : public LargeStep {
 public:
  // Keeps references.
  MultiplexedLargeStep(const Target& target, const TechniqueDistribution& techniques)
      : target_(target), techniques_(techniques) {}
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  double density(const Technique& technique) const override {
    return techniques_.probability(technique);
  }
  void splatSample(const ChainState& proposed, const Division& division,
                   SampleFilm& film) const override;

 private:
  const Target& target_;
  const TechniqueDistribution& techniques_;
};

LargeStepPlugin multiplexedLargeStep();

}  // namespace h2mc
