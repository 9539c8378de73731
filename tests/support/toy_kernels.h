// SPDX-License-Identifier: MIT
// The mixtures of kernels that the tests on targets of known distribution run.
#pragma once

#include <span>

#include "mcmc/chain/chain.h"
#include "mcmc/mutations/delayed_rejection.h"
#include "mcmc/mutations/hamiltonian_step.h"
#include "mcmc/mutations/isotropic_step.h"
#include "mcmc/mutations/multiplexed_large_step.h"
#include "render/core/index.h"

namespace h2mc::test {

struct ToyMixture {
  const char* name;
  double large, isotropic, hamiltonian;  // shares
  StepShape shape;
  float sigma;
  bool learned =
      false;  // the isotropic and the Hamiltonian share depend on the octave of the target
  double delayed =
      0;  // share of Hamiltonian steps where isotropic ones of twice the size were refused
};

// Has shares, and how long chains stay where they are, learned that leap from each octave of the target to the next.
inline void learnLeaps(KernelMixture& kernels) {
  ChainStatistics statistics(kernels.kinds(), 2);
  for (int octave = -kHighestOctave; octave <= kHighestOctave; ++octave) {
    statistics.departures[octaveRow(octave)] = octave % 2 == 0 ? 1000 : 250;
    for (std::size_t kind = 1; kind < at(std::min(3, kernels.kinds())); ++kind) {
      const bool good = (octave + static_cast<int>(kind)) % 2 == 0;
      statistics.octaves[kind][octaveRow(octave)] = {1000, good ? 600. : 200.};
    }
  }
  kernels.learn(statistics);
}

// All of the given techniques, of lengths 1 and 2, alike.
inline TechniqueDistribution evenly(std::span<const Technique> techniques) {
  TechniqueDistribution distribution(1, 2);
  std::vector<double> weights(static_cast<std::size_t>(distribution.size()), 0);
  for (const Technique& t : techniques) weights[at(distribution.index(t))] = 1;
  distribution.setWeights(weights, std::vector<bool>(weights.size(), true));
  return distribution;
}

// Keeps references.
inline KernelMixture toyKernels(const Target& target, const TechniqueDistribution& techniques,
                                const ToyMixture& mixture) {
  SlotNumbers slots;
  KernelMixture kernels;
  kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
  kernels.largeProbability = mixture.large;
  kernels.small.push_back({std::make_unique<IsotropicStep>(target, mixture.shape, mixture.sigma),
                           mixture.isotropic,
                           {}});
  HamiltonianSettings settings;
  settings.sigma = mixture.sigma;
  kernels.small.push_back(
      {std::make_unique<HamiltonianStep>(target, settings, slots), mixture.hamiltonian, {}});
  if (mixture.delayed > 0)
    kernels.small.push_back({std::make_unique<DelayedRejection>(
                                 target, "delayed", 2 * mixture.sigma,
                                 std::make_unique<HamiltonianStep>(target, settings, slots)),
                             mixture.delayed,
                             {}});
  if (mixture.learned) {
    kernels.meanTarget = 1;
    for (KernelMixture::Small& s : kernels.small) s.cost = 1;
    learnLeaps(kernels);
  }
  return kernels;
}

}  // namespace h2mc::test
