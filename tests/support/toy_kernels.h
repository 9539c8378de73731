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
  bool learned =
      false;  // the isotropic and the Hamiltonian share depend on the level of the target
};

// Has shares learned that leap from each level of the target to the next.
inline void learnLeaps(KernelMixture& kernels) {
  ChainStatistics statistics(kernels.kinds(), 2);
  for (int level = -kHighestLevel; level <= kHighestLevel; ++level)
    for (std::size_t kind = 1; kind < 3; ++kind) {
      const bool good = (level + static_cast<int>(kind)) % 2 == 0;
      statistics.levels[kind][KernelMixture::at(level)] = {1000, good ? 600. : 200.};
    }
  kernels.learn(statistics);
}

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
  if (mixture.learned) {
    kernels.brightness = 1;
    for (KernelMixture::Small& s : kernels.small) s.cost = 1;
    learnLeaps(kernels);
  }
  return kernels;
}

}  // namespace h2mc::test
