// SPDX-License-Identifier: MIT
#include "mcmc/methods/lmc.h"

#include "mcmc/methods/beside_isotropic.h"

namespace h2mc {

MetropolisMethod lmcMethod() {
  // Of a Langevin step, in isotropic ones.
  static constexpr double kCost = 2.5;
  return methodBesideIsotropic(
      "lmc",
      "Metropolis light transport with Langevin steps, by gradients alone [Luan et al. 2020]",
      [](const OptionSet& options) {
        return besideIsotropic(options, "langevin", kCost, "isotropicThenLangevin");
      });
}

}  // namespace h2mc
