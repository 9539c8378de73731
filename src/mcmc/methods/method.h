// SPDX-License-Identifier: MIT
// A Metropolis method: the mixture of mutations that its chains run, who they are, and its options.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mcmc/chain/kernel_mixture.h"
#include "mcmc/mutations/technique_distribution.h"
#include "mcmc/populations/population.h"
#include "mcmc/targets/target.h"
#include "render/scene/option_set.h"

namespace h2mc {

// A method is a function that returns this, in a file of its own, and a line in methods.cpp.
struct MetropolisMethod {
  std::string_view name, description;  // one line
  // A small step of its mixture, by name in the list of mutations.
  struct Step {
    std::string_view mutation;
    double share;                // of the small steps
    std::optional<double> cost;  // see KernelMixture::Small
  };
  // The mixture that the options ask for. Whatever they are, the same mutations in the same order; those without a
  // share are left out of the chains'.
  std::vector<Step> (*steps)(const OptionSet& options);
  // The options besides those that all methods have and those of its mutations.
  std::vector<Parameter> ownParameters;
  // Throws OptionError for values of its own options that are out of range; may be null.
  void (*check)(const OptionSet& options) = nullptr;
  // Who its chains are.
  std::unique_ptr<Population> (*population)() = resampledChains;

  // All options: those of every method, those of its mutations, its own. Filled in by the list.
  std::vector<Parameter> parameters = {};
  IntegratorPlugin plugin() const { return {name, description, parameters}; }
};

// The options that every Metropolis method has.
std::span<const Parameter> sharedParameters();

// Throws OptionError for values out of range.
void checkOptions(const MetropolisMethod& method, const OptionSet& options);

// The mixture that chains of this method run, with its options; it does not know the mean of the target. Keeps
// references to the target and, for multiplexed large steps, to the techniques.
KernelMixture makeKernels(const MetropolisMethod& method, const PathTarget& target,
                          const TechniqueDistribution& techniques, const OptionSet& options,
                          int minLength);

}  // namespace h2mc
