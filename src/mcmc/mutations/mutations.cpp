// SPDX-License-Identifier: MIT
#include "mcmc/mutations/mutations.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "mcmc/mutations/bidirectional_large_step.h"
#include "mcmc/mutations/caustic.h"
#include "mcmc/mutations/delayed_rejection.h"
#include "mcmc/mutations/hamiltonian_step.h"
#include "mcmc/mutations/isotropic_step.h"
#include "mcmc/mutations/langevin_step.h"
#include "mcmc/mutations/lens_step.h"
#include "mcmc/mutations/lens_subpath.h"
#include "mcmc/mutations/multi_chain.h"
#include "mcmc/mutations/multiplexed_large_step.h"
#include "mcmc/mutations/technique_change.h"
#include "mcmc/mutations/veach_bidirectional.h"
#include "mcmc/mutations/veach_lens.h"
#include "mcmc/mutations/whole_sample_steps.h"

namespace h2mc {

// A new mutation is a line here: options, `h2mc list mutations` and the tests of exactness find it by that.
std::span<const MutationPlugin> mutations() {
  static const std::array list = {isotropicStep(),
                                  hamiltonianStep(),
                                  langevinStep(),
                                  lensStep(),
                                  techniqueChange(),
                                  veachLens(),
                                  multiChain(),
                                  causticPerturbation(),
                                  lensSubpath(),
                                  veachBidirectional(),
                                  wholeSampleStep(),
                                  isotropicThenTimid(),
                                  isotropicThenHamiltonian(),
                                  isotropicThenLangevin()};
  return list;
}

std::span<const LargeStepPlugin> largeSteps() {
  static const std::array list = {bidirectionalLargeStep(), multiplexedLargeStep()};
  return list;
}

namespace {

template <class Plugin>
const Plugin& named(std::span<const Plugin> list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Plugin& p) { return p.name == name; });
  assert(found != list.end());
  return *found;
}

}  // namespace

const MutationPlugin& mutationNamed(std::string_view name) { return named(mutations(), name); }
const LargeStepPlugin& largeStepNamed(std::string_view name) { return named(largeSteps(), name); }

}  // namespace h2mc
