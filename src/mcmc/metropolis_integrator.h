// The Metropolis integrators: bootstrap, chains, a mixture of mutations, a film. A method is the
// mixture that it runs.
#pragma once

#include "mcmc/chain.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// A method: its options and the small steps it runs.
struct MetropolisMethod {
  IntegratorPlugin plugin;
  std::vector<KernelMixture::Small> (*smallSteps)(const SceneTarget& target,
                                                  const OptionSet& options);
  void (*check)(const OptionSet& options) = nullptr;  // throws OptionError for its own options
};

// The mixture that chains of this method run, with its options; brightness is 0. Keeps references to
// the target and, for multiplexed large steps, to the techniques.
KernelMixture makeKernels(const MetropolisMethod& method, const SceneTarget& target,
                          const TechniqueDistribution& techniques, const OptionSet& options,
                          int minLength);

// Throws OptionError for options out of range.
std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options);

}  // namespace h2mc
