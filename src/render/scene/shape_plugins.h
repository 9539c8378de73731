// The shapes a scene file can name.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "render/geometry/shape.h"
#include "render/scene/plugin.h"
#include "render/scene/properties.h"

namespace h2mc {

struct ShapeGeometry {
  std::variant<TriangleMesh, Sphere, Disk> geometry;
  std::size_t dropped = 0;  // triangles without area, left out
};

// Every shape, in `h2mc list`'s order. An empty mesh comes back when all its triangles were dropped.
std::span<const Plugin<ShapeGeometry>> shapePlugins();

}  // namespace h2mc
