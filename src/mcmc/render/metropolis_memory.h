// SPDX-License-Identifier: MIT
// What a Metropolis render takes.
#pragma once

#include "render/integrator/integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

// Throws MemoryError where films, chains and bootstrap would take more than there is. `maxLength`: of the paths, in
// edges; `bootstrapSamples`: at most.
void requireMetropolisMemory(const Scene& scene, const OptionSet& options,
                             const RenderRequest& request, int maxLength,
                             long long bootstrapSamples);

}  // namespace h2mc
