// SPDX-License-Identifier: MIT
// Where lines meet spheres, disks, cylinders and triangles, in double: Embree asks that of all but its own meshes.
#pragma once

#include <cstdint>

#include "render/core/types.h"
#include "render/geometry/shape.h"

namespace h2mc {

// The points origin + t direction, near < t < far, at a moment of the shutter's opening. The direction may be of
// any length.
struct Segment {
  glm::dvec3 origin, direction;
  double near, far;
  float time;
};

// Whether the segment meets the sphere, disk or cylinder, first at `t`; `root` is the PrimitiveId's `primitive`: 1
// for the farther of a sphere's or cylinder's two points on the line. Origins that are off the surface by a few ulps of
// float are clearly on one side. Precondition: no mesh.
bool hitRound(const Shape& shape, const Segment& segment, double& t, std::uint32_t& root);

// The same of a mesh's triangle. Triangles that share an edge leave no gap there. Precondition: a mesh.
bool hitTriangle(const Shape& shape, std::uint32_t triangle, const Segment& segment, double& t);

}  // namespace h2mc
