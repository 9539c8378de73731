// SPDX-License-Identifier: MIT
#include "mcmc/methods/pssmlt.h"

namespace h2mc {

MetropolisMethod pssmltMethod() {
  return {"pssmlt",
          "primary sample space Metropolis light transport: steps of whole bidirectional samples "
          "[Kelemen et al. 2002]",
          [](const OptionSet&) -> std::vector<MetropolisMethod::Step> {
            return {{"wholeSample", 1, {}}};
          },
          {}};
}

}  // namespace h2mc
