// SPDX-License-Identifier: MIT
// Steps drawn from the Gaussian that Hamiltonian dynamics gives at the state.
#pragma once

#include "mcmc/mutations/gaussian_step.h"

namespace h2mc {

// Steps drawn from hamiltonianGaussian() at the state; where there are no derivatives, from the prior.
class HamiltonianStep final : public GaussianStep {
 public:
  // Keeps a reference.
  HamiltonianStep(const Target& target, const HamiltonianSettings& settings, SlotNumbers& slots)
      : GaussianStep(target, settings.sigma, slots), settings_(settings) {}
  std::string_view name() const override { return "hamiltonian"; }

 private:
  void make(const Path& path, MutationContext& context, Gaussian& gaussian) const override;

  HamiltonianSettings settings_;
};

// The options sigma, trajectoryLength and maxDrift, as far as there are any.
HamiltonianSettings hamiltonianSettings(const OptionSet& options);

MutationPlugin hamiltonianStep();

}  // namespace h2mc
