// SPDX-License-Identifier: MIT
// Spheres and cylinders as meshes, for what transforms make of them that is neither.
#pragma once

#include <optional>

#include "render/geometry/mesh_data.h"

namespace h2mc {

// The unit sphere, of 65,000 triangles with exact normals and the texture coordinates of a Sphere.
MeshData makeUnitSphere();
// The open cylinder of radius 1 around z from 0 to 1, of 2048 triangles with exact normals and the texture coordinates
// of a Cylinder whose axisX is x.
MeshData makeUnitCylinder();

// The one scale of a transform's linear part that scales alike in all directions, mirrored or not.
std::optional<double> uniformScale(const glm::dmat3& linear);
// The scale across the axis where a cylinder's image is one, whatever the scale along it. Unit: its axis, and a
// direction across.
std::optional<double> roundScale(const glm::dmat3& linear, const glm::dvec3& axis,
                                 const glm::dvec3& across);

}  // namespace h2mc
