#pragma once

#include "mcmc/metropolis_integrator.h"

namespace h2mc {

MetropolisMethod h2mcMethod();

}  // namespace h2mc
