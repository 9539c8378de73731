// SPDX-License-Identifier: MIT
#pragma once

#include "render/integrator/common_options.h"
#include "render/integrator/integrator.h"

namespace h2mc {

IntegratorFactory bdptIntegrator();

}  // namespace h2mc
