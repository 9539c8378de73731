// SPDX-License-Identifier: MIT
// The Metropolis integrators: bootstrap, chains, a mixture of mutations, a film.
#pragma once

#include "mcmc/methods/method.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// Keeps a reference to the method. Throws OptionError for options out of range.
std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options);

}  // namespace h2mc
