// SPDX-License-Identifier: MIT
// Every integrator there is.
#pragma once

#include "render/integrator/integrator.h"

namespace h2mc {

// path, bdpt, photon, the Metropolis methods, and those of tours.
std::span<const IntegratorFactory> allIntegrators();
// Their tables, for the scene reader.
std::vector<IntegratorPlugin> integratorPlugins();

}  // namespace h2mc
