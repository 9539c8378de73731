// SPDX-License-Identifier: MIT
#include "render/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "render/geometry/placed_mesh.h"
#include "render/geometry/ray_tracer.h"
#include "render/path/light_use.h"

namespace h2mc {
namespace {

struct Box {
  glm::dvec3 low{INFINITY}, high{-INFINITY};

  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const TriangleMesh& mesh) {
    for (const Vec3f& p : mesh.positions) add(glm::dvec3(p));
  }
  // Between its steps a moving shape lies within what they span.
  void add(const MovingMesh& mesh) {
    for (const Vec3f& p : mesh.positions) add(glm::dvec3(p));
  }
  void add(const MovingSphere& sphere) {
    for (const Sphere& step : sphere.steps) add(step);
  }
  void add(const MeshInstance& instance) { add(*instance.shared, instance.placement); }
  void add(const MovingMeshInstance& instance) {
    for (const Placement& step : instance.steps) add(*instance.shared, step);
  }
  void add(const SharedMesh& shared, const Placement& placement) {
    for (const glm::dvec3& corner : placedCorners(shared, placement)) add(corner);
  }
  void add(const MovingDisk& disk) {
    for (const Disk& step : disk.steps) add(step);
  }
  void add(const Sphere& sphere) {
    add(glm::dvec3(sphere.center) - glm::dvec3(sphere.radius));
    add(glm::dvec3(sphere.center) + glm::dvec3(sphere.radius));
  }
  void add(const MovingCylinder& cylinder) {
    for (const Cylinder& step : cylinder.steps) add(step);
  }
  void add(const Cylinder& cylinder) {
    for (const glm::dvec3 end : {glm::dvec3(cylinder.start), glm::dvec3(cylinder.end)}) {
      add(end - glm::dvec3(cylinder.radius));
      add(end + glm::dvec3(cylinder.radius));
    }
  }
  void add(const Disk& disk) {
    const glm::dvec3 x(disk.axisX), y(disk.axisY);
    const glm::dvec3 extent = glm::sqrt(x * x + y * y);
    add(glm::dvec3(disk.center) - extent);
    add(glm::dvec3(disk.center) + extent);
  }
};

}  // namespace

Scene::Scene() = default;
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

SceneBounds boundsOf(std::span<const Shape> shapes) {
  Box box;
  for (const Shape& shape : shapes)
    std::visit([&](const auto& geometry) { box.add(geometry); }, shape.geometry);
  SceneBounds bounds;
  if (!(box.low.x <= box.high.x)) return bounds;
  bounds.center = Vec3f(0.5 * (box.low + box.high));
  // A little more, so that rounding leaves no point outside.
  const double radius = 0.5 * glm::length(box.high - box.low) * (1 + 1e-5);
  bounds.radius = std::max(static_cast<float>(radius), 1e-6f);
  return bounds;
}

bool Scene::hasBeam() const { return std::any_of(lights.begin(), lights.end(), isBeam); }

void Scene::finish() {
  moving = camera.moves() || std::any_of(shapes.begin(), shapes.end(),
                                         [](const Shape& shape) { return shape.moves(); });
  bounds = boundsOf(shapes);
  prepareLights(lights, shapes);
  sunLights.clear();
  suns.clear();
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (auto* sun = std::get_if<SunLight>(&lights[i])) {
      sunLights.push_back(static_cast<int>(i));
      suns.push_back(sun->disc());
      if (environment < 0) continue;
      std::visit(
          [&](const auto& l) {
            if constexpr (kBehindSuns<std::remove_cvref_t<decltype(l)>>) sun->setBehind(l);
          },
          lights[at(environment)]);
    }
  std::vector<double> powers, direct;
  for (const Light& light : lights) {
    powers.push_back(
        static_cast<double>(std::visit([&](const auto& l) { return l.power(bounds); }, light)));
    direct.push_back(isBeam(light) ? 0 : powers.back());
  }
  directPicker = LightPicker(direct);
  emissionPicker = LightPicker(powers);
  tracer = std::make_unique<RayTracer>(shapes);
  if (lights.size() > 1) pickLightsByUse(*this);
}

}  // namespace h2mc
