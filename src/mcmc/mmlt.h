#pragma once

#include "mcmc/metropolis_integrator.h"

namespace h2mc {

MetropolisMethod mmltMethod();

}  // namespace h2mc
