#pragma once

#include "mcmc/metropolis_integrator.h"

namespace h2mc {

MetropolisMethod h2mcMethod();

// From the options sigma, trajectoryLength and maxDrift; the defaults for those the method lacks.
HamiltonianSettings hamiltonianSettings(const OptionSet& options);

}  // namespace h2mc
