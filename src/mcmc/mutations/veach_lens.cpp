// SPDX-License-Identifier: MIT
#include "mcmc/mutations/veach_lens.h"

#include "mcmc/mutations/mutation_options.h"

namespace h2mc {

MutationPlugin veachLens() {
  static constexpr Parameter kParameters[] = {kRoughnessThresholdParameter};
  return {
      "veachLens",
      "the pixel moves by Veach's radial law, the path stays where it is as soon as it can, its "
      "technique is drawn anew [Veach and Guibas 1997]",
      kParameters, [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
        return std::make_unique<VeachLens>(setup.target, roughnessThreshold(setup.options),
                                           setup.slots);
      }};
}

}  // namespace h2mc
