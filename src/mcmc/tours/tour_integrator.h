// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/tours/tour_method.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// Throws OptionError for values out of range. Keeps a reference to the method.
std::unique_ptr<Integrator> makeTourIntegrator(const TourMethod& method, const OptionSet& options);

}  // namespace h2mc
