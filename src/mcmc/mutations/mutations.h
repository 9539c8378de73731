// SPDX-License-Identifier: MIT
// The list of mutations: each declares itself, and is made from its parameters.
#pragma once

#include <memory>
#include <span>

#include "mcmc/chain/large_step.h"
#include "mcmc/chain/mutation.h"
#include "render/scene/option_set.h"

namespace h2mc {

template <class Kernel>
struct KernelPlugin {
  std::string_view name, description;  // one line
  std::span<const Parameter> parameters;
  std::unique_ptr<Kernel> (*create)(const MutationSetup& setup);
  // Throws OptionError for values out of range of its parameters; may be null.
  void (*check)(const OptionSet& options) = nullptr;
  // Knows mixtures of MutationSetup::wholeSamples.
  bool wholeSamples = false;
};
using MutationPlugin = KernelPlugin<Mutation>;
using LargeStepPlugin = KernelPlugin<LargeStep>;

// Small steps: those that keep to the state's neighbourhood, or to its path.
std::span<const MutationPlugin> mutations();
// Proposals that do not depend on the state: of these a mixture has one.
std::span<const LargeStepPlugin> largeSteps();

// By name. Precondition: it is in the list.
const MutationPlugin& mutationNamed(std::string_view name);
const LargeStepPlugin& largeStepNamed(std::string_view name);

}  // namespace h2mc
