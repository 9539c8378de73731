// SPDX-License-Identifier: MIT
#include "mcmc/methods/rjmlt.h"

#include "mcmc/methods/shared_steps.h"

namespace h2mc {

MetropolisMethod rjmltMethod() {
  return {"rjmlt",
          "reversible jump Metropolis light transport: mmlt that also changes a path's technique "
          "[Bitterli et al. 2017]",
          [](const OptionSet& options) -> std::vector<MetropolisMethod::Step> {
            const double lens = options.number("lensProbability");
            const double technique = options.number("techniqueProbability");
            return {{"lens", lens * (1 - technique), {}},
                    {"isotropic", (1 - lens) * (1 - technique), {}},
                    {"technique", technique, {}}};
          },
          {kLensProbabilityParameter,
           {"techniqueProbability", ParameterType::kNumber, "0.05",
            "share of changes of technique among the steps that are not large"}},
          [](const OptionSet& options) {
            requireRange(options, "lensProbability", 0, 1);
            requireRange(options, "techniqueProbability", 0, 1);
          }};
}

}  // namespace h2mc
