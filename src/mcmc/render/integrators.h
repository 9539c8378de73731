// SPDX-License-Identifier: MIT
// Every integrator there is.
#pragma once

#include "render/integrator/integrator.h"

namespace h2mc {

// path, bdpt, and the Metropolis methods.
std::span<const IntegratorFactory> allIntegrators();

}  // namespace h2mc
