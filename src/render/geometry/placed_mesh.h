// SPDX-License-Identifier: MIT
// Where an instance lies, without a look at its vertices.
#pragma once

#include <algorithm>
#include <array>

#include "render/geometry/shape.h"

namespace h2mc {

// What a placement does to lengths.
struct Stretch {
  double longest = 0;    // factor along the axis that grows most
  double condition = 0;  // that, times the same of the inverse; 1 where all directions are alike
};

inline Stretch stretchOf(const Placement& placement) {
  const glm::dmat3 m(placement.toWorld()), inverse = glm::inverse(m);
  double grows = 0, shrinks = 0;
  for (int i = 0; i < 3; ++i) {
    grows = std::max(grows, glm::length(m[i]));
    shrinks = std::max(shrinks, glm::length(inverse[i]));
  }
  return {grows, grows * shrinks};
}

// The corners of the mesh's box: the placed mesh lies between them.
inline std::array<glm::dvec3, 8> placedCorners(const SharedMesh& shared,
                                               const Placement& placement) {
  const Vec3f ends[2] = {shared.low, shared.high};
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = placement.point({ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z});
  return corners;
}

}  // namespace h2mc
