// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

// Langevin Monte Carlo [Luan et al. 2020]: isotropic, Langevin and lens steps.
MetropolisMethod lmcMethod();

}  // namespace h2mc
