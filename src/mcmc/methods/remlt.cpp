// SPDX-License-Identifier: MIT
#include "mcmc/methods/remlt.h"

#include "mcmc/methods/shared_steps.h"

namespace h2mc {

MetropolisMethod remltMethod() {
  return {
      "remlt",
      "replica exchange light transport: mmlt whose chains change places with chains of flatter "
      "targets [after Kitaoka et al. 2009]",
      [](const OptionSet& options) -> std::vector<MetropolisMethod::Step> {
        const double lens = options.number("lensProbability");
        return {{"lens", lens, {}}, {"isotropic", 1 - lens, {}}};
      },
      {kLensProbabilityParameter,
       {"replicas", ParameterType::kInteger, "2",
        "chains of flatter targets beside each group of two or more chains; they are mutated "
        "as much as one of these, and not counted"},
       {"leastPower", ParameterType::kNumber, "0.4",
        "power of the luminance that the flattest of them has for its target; the others lie "
        "evenly between it and 1"}},
      [](const OptionSet& options) {
        requireRange(options, "lensProbability", 0, 1);
        requireRange(options, "replicas", 1, 64);
        requireRange(options, "leastPower", 0.01, 1);
      }};
}

}  // namespace h2mc
