// SPDX-License-Identifier: MIT
// A path whose pixel moves while the rest stays where it is as soon as it can: what the lens
// perturbation does, as a function of the film position.
#pragma once

#include "render/path/derivative.h"

namespace h2mc {

// Gradient and Hessian, with respect to the film position, of the log of the path's target in the
// measure (film position, primary coordinates up to vertex `reconnection`, areas of the vertices
// after it). Camera vertices before and at `reconnection` follow the film position, those after it
// stay. result.dimension is 2. Preconditions: path.target > 0, path.technique.t >= 2,
// 1 <= reconnection <= t - 1, and the scatterings at `reconnection` and at the vertex after it are
// none of delta lobes.
void differentiateLens(const Scene& scene, const Path& path, int reconnection, Derivative& result);

}  // namespace h2mc
