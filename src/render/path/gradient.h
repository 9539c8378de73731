// SPDX-License-Identifier: MIT
// The gradient of the log target with respect to a path's primary coordinates, without its Hessian, for steps that ask
// for no more: the whole path by ad::Dual1, up to sixteen coordinates at a time.
#pragma once

#include "render/path/path.h"

namespace h2mc {

struct Gradient {
  int dimension = 0;
  float logTarget = 0;
  float gradient[kMaxCoordinates];

  // All entries finite.
  bool finite() const;
};

// d log(path.target) at path.sample, with the topology (triangles, lobes, light, visibility) frozen.
// result.dimension is path.dimension(): where the path depends on time, that is the last coordinate. Precondition:
// path.target > 0.
void differentiateOnce(const Scene& scene, const Path& path, Gradient& result);

}  // namespace h2mc
