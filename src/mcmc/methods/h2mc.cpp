// SPDX-License-Identifier: MIT
#include "mcmc/methods/h2mc.h"

#include "mcmc/methods/beside_isotropic.h"

namespace h2mc {

MetropolisMethod h2mcMethod() {
  // Of a Hamiltonian step, in isotropic ones: 2.5 to 4 by the benchmark, where the derivatives at the present state are
  // there already; after a step of another kind they are not.
  static constexpr double kCost = 4;
  return methodBesideIsotropic(
      "h2mc", "Metropolis light transport with Hessian-Hamiltonian proposals [Li et al. 2015]",
      [](const OptionSet& options) {
        return besideIsotropic(options, "hamiltonian", kCost, "isotropicThenHamiltonian");
      });
}

}  // namespace h2mc
