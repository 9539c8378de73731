// SPDX-License-Identifier: MIT
#include "mcmc/methods/mmlt.h"

#include "mcmc/methods/lens_share.h"

namespace h2mc {

MetropolisMethod mmltMethod() {
  return {
      "mmlt",
      "multiplexed Metropolis light transport with isotropic small steps [Hachisuka et al. 2014]",
      [](const OptionSet& options) -> std::vector<MetropolisMethod::Step> {
        const double lens = options.number("lensProbability");
        return {{"lens", lens, {}}, {"isotropic", 1 - lens, {}}};
      },
      {kLensProbabilityParameter},
      [](const OptionSet& options) { requireRange(options, "lensProbability", 0, 1); }};
}

}  // namespace h2mc
