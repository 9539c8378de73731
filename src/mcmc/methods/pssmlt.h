// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

// Primary sample space Metropolis light transport [Kelemen et al. 2002]: steps of a whole bidirectional sample.
MetropolisMethod pssmltMethod();

}  // namespace h2mc
