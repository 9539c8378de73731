// SPDX-License-Identifier: MIT
// Shapes that deform: the same triangles in two or more states.
#include <algorithm>
#include <cmath>

#include "render/core/index.h"
#include "render/geometry/mesh_data.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"

namespace h2mc {
namespace {

// Reads a nested shape as a mesh at rest.
TriangleMesh readState(ReaderContext& context, const XmlElement& element) {
  const auto& plugin = findPlugin(shapePlugins(), element, "shape");
  if (!plugin.create)
    throw sourceError(element.place("type"),
                      "a shape \"" + std::string(plugin.name) + "\" inside a deforming shape",
                      "expected a mesh");
  const ElementProperties properties(context, element, {"shape", plugin.parameters, 0, {}, false});
  ShapeGeometry made = createLocated(properties, plugin.create);
  auto* mesh = std::get_if<TriangleMesh>(&made.geometry);
  if (!mesh)
    throw sourceError(element.place("type"),
                      std::holds_alternative<MovingMesh>(made.geometry)
                          ? "an <animation> inside a deforming shape"
                          : properties.description() + " can't deform",
                      "expected a mesh with a <transform>: its states make the motion");
  return std::move(*mesh);
}

void requireSameTriangles(const TriangleMesh& first, const TriangleMesh& mesh,
                          const XmlElement& element) {
  std::string what;
  if (mesh.positions.size() != first.positions.size())
    what = std::to_string(mesh.positions.size()) + " vertices here, " +
           std::to_string(first.positions.size()) + " in the first";
  else if (mesh.triangles != first.triangles)
    what = "the triangles are not the same, or one has area in this state alone";
  else if (mesh.normals.size() != first.normals.size())
    what = "one has normals and the other none";
  if (!what.empty())
    throw sourceError(element.place(),
                      "this state of the deforming shape does not fit the first: " + what,
                      "expected the same triangles in the same order, with other vertices");
}

// `share` of the way from a to b, normals not of unit length.
TriangleMesh between(const TriangleMesh& a, const TriangleMesh& b, double share) {
  TriangleMesh mesh = a;
  const auto mix = [&](std::vector<Vec3f>& to, const std::vector<Vec3f>& other) {
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = Vec3f(glm::dvec3(to[i]) + (glm::dvec3(other[i]) - glm::dvec3(to[i])) * share);
  };
  mix(mesh.positions, b.positions);
  mix(mesh.normals, b.normals);
  return mesh;
}

}  // namespace

ShapeGeometry readDeforming(ReaderContext& context, const ElementProperties& properties) {
  std::vector<TriangleMesh> states;
  for (const XmlElement& child : properties.element().children) {
    if (child.name != "shape") continue;
    states.push_back(readState(context, child));
    requireSameTriangles(states[0], states.back(), child);
  }
  if (states.size() < 2)
    throw sourceError(properties.element().place(), "a deforming shape needs two states",
                      "expected two or more <shape> elements inside");
  const Camera& camera = context.scene.camera;
  const double open = camera.shutterOpen, close = camera.shutterClose;
  const double start = properties.given("startTime") ? properties.number("startTime") : open;
  const double end = properties.given("endTime") ? properties.number("endTime") : close;
  if (!(start < end) && (properties.given("startTime") || properties.given("endTime")))
    properties.fail("endTime", "endTime must come after startTime");

  // A moment's place among the states: 0 the first, 1 the second, ...
  const double last = static_cast<double>(states.size() - 1);
  const auto placeOf = [&](double moment) {
    const double time = open + (close - open) * moment;
    return end > start ? std::clamp((time - start) / (end - start), 0.0, 1.0) * last : 0.0;
  };
  const auto stateAt = [&](double moment) {
    const double place = placeOf(moment);
    const double index = std::min(std::floor(place), last - 1);
    const auto i = at(index);
    return between(states[i], states[i + 1], place - index);
  };
  ShapeGeometry result;
  if (placeOf(0) == placeOf(1)) {
    result.geometry = stateAt(0);
    for (Vec3f& n : std::get<TriangleMesh>(result.geometry).normals) n = glm::normalize(n);
    return result;
  }

  // Between the states everything goes in straight lines already: the steps are off at most where a
  // state itself lies between two of them.
  std::vector<double> corners;
  for (double k = 0; k <= last; ++k) {
    const double moment = (start + (end - start) * k / last - open) / (close - open);
    if (moment > 0 && moment < 1) corners.push_back(moment);
  }
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const TriangleMesh& state : states)
    for (const Vec3f& p : state.positions) {
      low = glm::min(low, glm::dvec3(p));
      high = glm::max(high, glm::dvec3(p));
    }
  int segments = 1;
  for (;; ++segments) {
    double largest = 0;
    for (const double moment : corners) {
      const double index = std::min(std::floor(moment * segments + 1e-9), segments - 1.0);
      const double share = moment * segments - index;
      if (share < 1e-6) continue;
      const TriangleMesh a = stateAt(index / segments), b = stateAt((index + 1) / segments);
      const TriangleMesh chord = between(a, b, share), exact = stateAt(moment);
      for (std::size_t i = 0; i < exact.positions.size(); ++i)
        largest =
            std::max(largest, glm::length(glm::dvec3(chord.positions[i] - exact.positions[i])));
    }
    result.motionError = largest / glm::length(high - low);
    if (result.motionError <= kChordError || segments == kMaxMotionSegments) break;
  }
  std::vector<TriangleMesh> steps;
  for (int i = 0; i <= segments; ++i) steps.push_back(stateAt(static_cast<double>(i) / segments));
  result.geometry = joinSteps(std::move(steps));
  return result;
}

}  // namespace h2mc
