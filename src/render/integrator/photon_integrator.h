// SPDX-License-Identifier: MIT
#pragma once

#include "render/integrator/integrator.h"

namespace h2mc {

IntegratorFactory photonIntegrator();

}  // namespace h2mc
