// SPDX-License-Identifier: MIT
#pragma once

#include "render/integrator/camera_walk.h"
#include "render/integrator/common_options.h"
#include "render/integrator/integrator.h"
#include "render/integrator/sampling_integrator.h"

namespace h2mc {

std::unique_ptr<PixelSampler> makePathSampler(const PathOptions& options);

IntegratorFactory pathIntegrator();

}  // namespace h2mc
