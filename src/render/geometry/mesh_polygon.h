// SPDX-License-Identifier: MIT
// Triangles of a face with any number of corners.
#pragma once

#include <cstddef>
#include <span>

#include "render/geometry/mesh_data.h"

namespace h2mc {

// The most corners of a face that is not convex: its triangulation takes time with their square.
inline constexpr std::size_t kMostConcaveCorners = 4096;

// Adds the triangles of a polygon to the mesh, which has its vertices already. A fan around the first of at least 3
// corners where all of the fan's triangles face the same way (convex polygons), or else by cutting off ears [Meisters
// 1975, "Polygons Have Ears"]; what is left of a polygon without ears, which crosses itself, becomes a fan. False where
// it is not convex and has more than kMostConcaveCorners.
bool addPolygon(MeshData& mesh, std::span<const unsigned> corners);

}  // namespace h2mc
