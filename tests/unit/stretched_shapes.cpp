// SPDX-License-Identifier: MIT
// Spheres and cylinders under transforms that scale differently in different directions.
#include <gtest/gtest.h>

#include "render/core/random.h"
#include "render/geometry/ray_tracer.h"
#include "render/geometry/surface.h"
#include "scene_files.h"

namespace h2mc {
namespace {

std::string shape(const std::string& type, const std::string& toWorld, const std::string& more) {
  return R"(<scene version="0.6.0"><integrator type="path"/><sensor type="perspective"/><shape type=")" +
         type + "\"><transform name=\"toWorld\">" + toWorld + "</transform>" + more +
         R"(</shape><emitter type="constant"/></scene>)";
}
bool isNoted(const Scene& scene, const std::string& what) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

// A cylinder is round whatever its length is scaled by, turned or not.
TEST(StretchedShapes, CylindersMayBeScaledAlongTheirAxis) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(shape("cylinder",
                                        R"(<scale x="0.5" y="0.5" z="3"/><rotate x="1" angle="90"/>
<translate x="1"/>)",
                                        R"(<float name="radius" value="0.4"/>)"));
  const auto* cylinder = std::get_if<Cylinder>(&scene.shapes.at(0).geometry);
  ASSERT_TRUE(cylinder);
  EXPECT_NEAR(cylinder->radius, 0.2f, 1e-6f);
  EXPECT_LT(glm::distance(cylinder->start, Vec3f(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(cylinder->end, Vec3f(1, -3, 0)), 1e-5f);
  EXPECT_FALSE(isNoted(scene, "oval"));
}

// Rays towards a shape from all around: the share of the points found that `onSurface` agrees with.
template <class OnSurface>
void expectOnSurface(const Scene& scene, const Vec3f& middle, OnSurface&& onSurface) {
  Random random(1, 2, 3);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const float x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3f origin = middle + Vec3f(x - 0.5f, y - 0.5f, z - 0.5f) * 8.f;
    const Vec3f direction = glm::normalize(middle - origin);
    const PrimitiveId id = scene.tracer->intersect({origin}, direction);
    if (!id.valid()) continue;
    ++hits;
    onSurface(intersectPrimitive<float>(scene.shapes, id, origin, direction));
  }
  EXPECT_GT(hits, 1000);
}

TEST(StretchedShapes, OvalCylindersLieOnTheirSurface) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(
      shape("cylinder", R"(<scale x="2" y="1" z="1"/><translate x="0.4"/>)",
            R"(<point name="p1" x="0" y="0" z="2"/><float name="radius" value="0.5"/>)"));
  EXPECT_TRUE(scene.shapes.at(0).isMesh());
  EXPECT_TRUE(isNoted(scene, "an oval or slanting cylinder"));
  // Outwards, with u around it and v along it.
  const Scene round = folder.read(shape(
      "cylinder", "", R"(<point name="p1" x="0" y="0" z="2"/><float name="radius" value="0.5"/>)"));
  expectOnSurface(scene, Vec3f(0.4f, 0, 1), [&](const SurfacePoint<float>& p) {
    const Vec3f q = (p.p - Vec3f(0.4f, 0, 0)) / Vec3f(1, 0.5f, 1);
    EXPECT_NEAR(std::hypot(q.x, q.y), 1, 2e-5f);
    EXPECT_TRUE(q.z >= -1e-5f && q.z <= 2.00001f);
    const Vec3f n = glm::normalize(Vec3f(q.x, q.y / 0.5f, 0));
    EXPECT_GT(dot(n, p.shading.n), 0.99999f);
    EXPECT_GT(dot(n, p.ng), 0.999f);
    EXPECT_NEAR(p.uv.y, q.z / 2, 1e-5f);
    // The round cylinder at the same place before the transform.
    const Vec3f at(q.x * 0.5f, q.y * 0.5f, q.z);
    const Vec3f out = glm::normalize(Vec3f(at.x, at.y, 0));
    const PrimitiveId id = round.tracer->intersect({at + out}, -out);
    if (!id.valid()) return;
    const auto r = intersectPrimitive<float>(round.shapes, id, at + out, -out);
    float turn = std::abs(r.uv.x - p.uv.x);
    turn = std::min(turn, 1 - turn);
    EXPECT_LT(turn, 1e-4f);
  });
}

TEST(StretchedShapes, EllipsoidsLieOnTheirSurface) {
  testing::SceneFolder folder;
  for (const bool flip : {false, true}) {
    const Scene scene = folder.read(
        shape("sphere", R"(<scale x="2" y="1" z="-0.5"/><translate x="0.4"/>)",
              R"(<point name="center" x="0.1" y="0" z="0"/><float name="radius" value="0.8"/>
<boolean name="flipNormals" value=")" +
                  std::string(flip ? "true" : "false") + "\"/>"));
    EXPECT_TRUE(scene.shapes.at(0).isMesh());
    const Vec3f middle(0.6f, 0, 0), axes(1.6f, 0.8f, 0.4f);
    expectOnSurface(scene, middle, [&](const SurfacePoint<float>& p) {
      const Vec3f q = (p.p - middle) / axes;
      EXPECT_NEAR(glm::length(q), 1, 5e-4f);
      const Vec3f n = glm::normalize(q / axes) * (flip ? -1.f : 1.f);
      EXPECT_GT(dot(n, p.shading.n), 0.9999f);
      EXPECT_GT(dot(n, p.ng), 0.99f);
    });
  }
}

// They move, and they shine.
TEST(StretchedShapes, MoveAndShine) {
  testing::SceneFolder folder;
  const std::string lamp = R"(<emitter type="area"><rgb name="radiance" value="3"/></emitter>)";
  const Scene lamps = folder.read(shape("sphere", R"(<scale x="2" y="1" z="1"/>)", lamp));
  EXPECT_EQ(lamps.shapes.at(0).light, 0);
  // Of a prolate spheroid with half axes 2, 1, 1: 2 pi (1 + 2 / e asin(e)), e^2 = 3 / 4.
  const double e = std::sqrt(0.75), area = 2 * std::numbers::pi * (1 + 2 / e * std::asin(e));
  const float power =
      std::visit([&](const auto& l) { return l.power(lamps.bounds); }, lamps.lights.at(0));
  EXPECT_NEAR(power / (3 * std::numbers::pi * area), 1, 1e-3);
  const Scene moving = folder.read(
      R"(<scene version="0.6.0"><integrator type="path"/><sensor type="perspective">
<float name="shutterOpen" value="0"/><float name="shutterClose" value="1"/></sensor>
<shape type="cylinder"><animation name="toWorld">
<transform time="0"><scale x="2"/></transform><transform time="1"><scale x="2"/><translate x="3"/></transform>
</animation></shape><emitter type="constant"/></scene>)");
  EXPECT_TRUE(std::holds_alternative<MovingMesh>(moving.shapes.at(0).geometry));
}

// In a group the unit mesh is shared.
TEST(StretchedShapes, OvalInstancesOfCylinders) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(
      R"(<scene version="0.6.0"><integrator type="path"/><sensor type="perspective"/>
<shape type="shapegroup" id="group"><shape type="cylinder"><point name="p0" x="0" y="-1" z="0"/>
<point name="p1" x="0" y="1" z="0"/><float name="radius" value="0.5"/></shape></shape>
<shape type="instance"><ref id="group"/><transform name="toWorld"><scale x="2" y="1" z="1"/></transform></shape>
<shape type="instance"><ref id="group"/><transform name="toWorld"><scale x="1" y="3" z="1"/>
<translate x="9"/></transform></shape><emitter type="constant"/></scene>)");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<MeshInstance>(scene.shapes[0].geometry));
  // Longer, but round.
  EXPECT_TRUE(std::holds_alternative<Cylinder>(scene.shapes[1].geometry));
  expectOnSurface(scene, Vec3f(0), [&](const SurfacePoint<float>& p) {
    const Vec3f q = p.p / Vec3f(1, 1, 0.5f);
    EXPECT_NEAR(std::hypot(q.x, q.z), 1, 2e-5f);
    EXPECT_GT(dot(glm::normalize(Vec3f(q.x, 0, q.z / 0.5f)), p.shading.n), 0.9999f);
  });
}

}  // namespace
}  // namespace h2mc
