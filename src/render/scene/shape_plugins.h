// SPDX-License-Identifier: MIT
// The shapes a scene file can name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/geometry/shape.h"
#include "render/scene/plugin.h"
#include "render/scene/properties.h"

namespace h2mc {

struct ShapeGeometry {
  Geometry geometry;
  std::size_t dropped = 0;  // triangles without area, left out
  double motionError = 0;   // how far it is from its motion, as motionSegments() says
};

// A part of a mesh whose file names the materials of its triangles.
struct ShapePart {
  std::string material;  // "" where the file names none
  ShapeGeometry shape;
};
// The parts of an "obj" by the names after its usemtl; one where it has fewer than two.
std::vector<ShapePart> readObjParts(const Properties& p);

// Every shape, in `h2mc list`'s order. An empty mesh comes back when all its triangles were dropped.
// Those made of other shapes have no `create`: "deforming" (readDeforming()), "shapegroup" and "instance"
// (readInstance()).
std::span<const Plugin<ShapeGeometry>> shapePlugins();

}  // namespace h2mc
