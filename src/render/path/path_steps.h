// SPDX-License-Identifier: MIT
// Parts of tracePath's steps for paths whose vertices are known: what a step leaves in the path, without its ray.
#pragma once

#include "render/path/path.h"

namespace h2mc {

// Marks in path.wraps the coordinates, from `coordinate` on, of the scattering at `vertex` through its lobe.
void markScatterWraps(const Scene& scene, Path& path, const TracedVertex& vertex, int coordinate);
// The same of the coordinates of the light's sample. Preconditions: s >= 1, path.lightIndex is set.
void markLightWraps(const Scene& scene, Path& path);

// joinSubpaths where the subpaths' ends are known to see each other: casts no shadow ray. The camera's film
// and clipping planes still count.
bool joinVisible(const Scene& scene, Path& path);

}  // namespace h2mc
