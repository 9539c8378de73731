// SPDX-License-Identifier: MIT
#pragma once

#include "render/integrator/common_options.h"
#include "render/integrator/integrator.h"
#include "render/integrator/sampling_integrator.h"

namespace h2mc {

struct PathOptions {
  int minDepth = 1, maxDepth = kMaxPathLength;  // in edges
  int rrDepth = 5;                              // length from which Russian roulette may end a path
};
std::unique_ptr<PixelSampler> makePathSampler(const PathOptions& options);

IntegratorFactory pathIntegrator();

}  // namespace h2mc
