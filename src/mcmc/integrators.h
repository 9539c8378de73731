// Every integrator there is.
#pragma once

#include "render/integrator/integrator.h"

namespace h2mc {

// path, bdpt, mmlt, h2mc. A new Metropolis method is a line in the list behind this.
std::span<const IntegratorFactory> allIntegrators();

}  // namespace h2mc
