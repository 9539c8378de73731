// Every integrator there is.
#pragma once

#include "mcmc/metropolis_integrator.h"

namespace h2mc {

// path, bdpt, mmlt, h2mc.
std::span<const IntegratorFactory> allIntegrators();

// mmlt, h2mc. A new Metropolis method is a line in the list behind this.
std::span<const MetropolisMethod> metropolisMethods();

}  // namespace h2mc
