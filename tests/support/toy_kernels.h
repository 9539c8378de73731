// The mixtures of kernels that the tests on targets of known distribution run.
#pragma once

#include <span>

#include "mcmc/chain.h"
#include "mcmc/small_step.h"

namespace h2mc::test {

struct ToyMixture {
  const char* name;
  double large, isotropic, hamiltonian;  // shares
  StepShape shape;
  float sigma;
};

// All of the given techniques, of lengths 1 and 2, alike.
inline TechniqueDistribution evenly(std::span<const Technique> techniques) {
  TechniqueDistribution distribution(1, 2);
  std::vector<double> weights(static_cast<std::size_t>(distribution.size()), 0);
  for (const Technique& t : techniques)
    weights[static_cast<std::size_t>(distribution.index(t))] = 1;
  distribution.setWeights(weights, std::vector<bool>(weights.size(), true));
  return distribution;
}

// Keeps references.
inline KernelMixture toyKernels(const Target& target, const TechniqueDistribution& techniques,
                                const ToyMixture& mixture) {
  KernelMixture kernels;
  kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
  kernels.largeProbability = mixture.large;
  kernels.small.push_back({std::make_unique<IsotropicStep>(target, mixture.shape, mixture.sigma),
                           mixture.isotropic, mixture.isotropic});
  HamiltonianSettings settings;
  settings.sigma = mixture.sigma;
  kernels.small.push_back({std::make_unique<HamiltonianStep>(target, settings), mixture.hamiltonian,
                           mixture.hamiltonian});
  return kernels;
}

}  // namespace h2mc::test
