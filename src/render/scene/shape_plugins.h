// The shapes a scene file can name.
#pragma once

#include <span>
#include <string_view>

#include "render/geometry/shape.h"
#include "render/scene/plugin.h"
#include "render/scene/properties.h"

namespace h2mc {

struct ShapeGeometry {
  Geometry geometry;
  std::size_t dropped = 0;  // triangles without area, left out
  double motionError = 0;   // how far it is from its motion, as motionSegments() says
};

// Every shape, in `h2mc list`'s order. An empty mesh comes back when all its triangles were dropped.
// "deforming" has no `create`: it is made of other shapes, by readDeforming().
std::span<const Plugin<ShapeGeometry>> shapePlugins();

}  // namespace h2mc
