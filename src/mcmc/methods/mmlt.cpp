// SPDX-License-Identifier: MIT
#include "mcmc/methods/mmlt.h"

#include "mcmc/methods/shared_steps.h"

namespace h2mc {

MetropolisMethod mmltMethod() {
  return {
      "mmlt",
      "multiplexed Metropolis light transport with isotropic small steps [Hachisuka et al. 2014]",
      [](const OptionSet& options) -> std::vector<MetropolisMethod::Step> {
        const double lens = options.number("lensProbability");
        const bool delayed = options.boolean("delayedRejection");
        return {{"lens", lens, {}},
                {"isotropic", delayed ? 0 : 1 - lens, {}},
                {"isotropicThenTimid", delayed ? 1 - lens : 0, {}}};
      },
      {kLensProbabilityParameter, kDelayedRejectionParameter},
      [](const OptionSet& options) { requireRange(options, "lensProbability", 0, 1); }};
}

}  // namespace h2mc
