// SPDX-License-Identifier: MIT
#include "mcmc/tours/erpt.h"

#include "render/integrator/common_options.h"

namespace h2mc {

TourMethod erptMethod() {
  return {"erpt",
          "energy redistribution path tracing: short chains from fresh bidirectional samples, as "
          "many as these are bright [Cline et al. 2005]",
          {{"numChains", ParameterType::kNumber, "1",
            "chains that begin at a bidirectional sample, on average"},
           {"chainLength", ParameterType::kInteger, "100", "mutations of a chain"}},
          [](const OptionSet& options) {
            requireRange(options, "numChains", 1e-3, 1e6);
            requireRange(options, "chainLength", 1, kNoLimit);
          },
          [](const OptionSet& options, double meanTarget) {
            return energyRedistribution(meanTarget, options.number("numChains"),
                                        options.integer("chainLength"));
          },
          [](const OptionSet& options) {
            return options.number("numChains") * options.integer("chainLength");
          }};
}

}  // namespace h2mc
