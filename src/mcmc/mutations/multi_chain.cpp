// SPDX-License-Identifier: MIT
#include "mcmc/mutations/multi_chain.h"

#include "mcmc/mutations/mutation_options.h"

namespace h2mc {

MutationPlugin multiChain() {
  static constexpr Parameter kParameters[] = {kRoughnessThresholdParameter};
  return {"multiChain",
          "as veachLens, for paths with several smooth stretches: the directions at the rough "
          "vertices between them turn a little [Veach 1997]",
          kParameters, [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<MultiChain>(setup.target, roughnessThreshold(setup.options),
                                                setup.slots);
          }};
}

}  // namespace h2mc
