// SPDX-License-Identifier: MIT
// Moving shapes: as they are read, and whether Embree sees what the templated code computes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "geometry_cases.h"
#include "motion_scenes.h"
#include "render/geometry/ray_tracer.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

using h2mc::testing::kLight;
using h2mc::testing::SceneFolder;

std::string scene(const std::string& body, const std::string& shutter = "0 1") {
  const std::size_t space = shutter.find(' ');
  return "<scene version=\"0.6.0\">\n" + body +
         "<sensor type=\"perspective\"><float name=\"shutterOpen\" value=\"" +
         shutter.substr(0, space) + "\"/><float name=\"shutterClose\" value=\"" +
         shutter.substr(space + 1) + "\"/></sensor>" + kLight + "</scene>\n";
}

// A tetrahedron, moved by (x, y, 0).
std::string tetrahedron(double x, double y) {
  const auto v = [&](double a, double b, double c) {
    return "v " + std::to_string(a + x) + " " + std::to_string(b + y) + " " + std::to_string(c) +
           "\n";
  };
  return v(0, 0, 0) + v(1, 0, 0) + v(0, 1, 0) + v(0, 0, 1) + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

const char* const kTurn =
    R"(<animation name="toWorld"><transform time="0"><scale x="1" y="0.6" z="1.4"/></transform>
       <transform time="1"><scale x="1" y="0.6" z="1.4"/><rotate x="1" y="0.4" angle="130"/>
       <translate x="2" y="-1"/></transform></animation>)";
const char* const kRoll =
    R"(<animation name="toWorld"><transform time="0"><translate x="-1"/></transform>
       <transform time="0.3"><scale value="1.5"/><rotate z="1" angle="90"/><translate x="2" y="-1"/></transform>
       <transform time="1"><scale value="0.7"/><rotate z="1" angle="170"/><translate y="1"/></transform></animation>)";

std::string shape(const std::string& type, const std::string& content) {
  return "<shape type=\"" + type + "\">" + content + "</shape>\n";
}

// Every kind of moving shape, each in a scene of its own. `folder` must outlive the scenes.
std::vector<Scene> everyMovingShape(const SceneFolder& folder) {
  folder.write("a.obj", tetrahedron(0, 0));
  folder.write("b.obj", tetrahedron(2, 0));
  folder.write("c.obj", tetrahedron(2, 1.5));
  const auto file = [](const char* name) {
    return "<string name=\"filename\" value=\"" + std::string(name) + ".obj\"/>";
  };
  std::vector<Scene> scenes;
  for (const std::string& text :
       {shape("cube", kTurn), shape("rectangle", kTurn), shape("disk", kTurn),
        shape("sphere", kRoll), shape("obj", file("a") + kTurn),
        shape("deforming",
              shape("obj", file("a")) + shape("obj", file("b")) + shape("obj", file("c")))})
    scenes.push_back(folder.read(scene(text)));
  return scenes;
}

// Rays at random times: what Embree hits, and at what distance, is what intersectPrimitive says.
TEST(MovingShapes, EmbreeSeesTheSame) {
  const SceneFolder folder;
  int index = 0;
  for (const Scene& s : everyMovingShape(folder)) {
    SCOPED_TRACE(s.shapes[0].name + " " + std::to_string(index++));
    ASSERT_TRUE(s.moving);
    ASSERT_TRUE(s.shapes[0].moves());
    Random random(5, static_cast<std::uint64_t>(index), 0);
    int hits = 0;
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const float time = random.uniform();
      const Vec3f target = s.bounds.center + randomPoint(random) * s.bounds.radius * 0.6f;
      const Vec3f direction = randomDirection(random);
      const Vec3f origin = target - direction * (3 * s.bounds.radius);
      const PrimitiveId id = s.tracer->intersect({origin}, direction, 0, RayTracer::kFar, time);
      if (!id.valid()) continue;
      const auto point = intersectPrimitive<float>(s.shapes, id, origin, direction, &time);
      if (std::abs(dot(point.ng, direction)) < 0.02f) continue;  // grazing: ill-conditioned
      ++hits;
      // On the ray, and on the primitive as it is at that time.
      const float t = dot(point.p - origin, direction);
      worst = std::max(worst, double(glm::length(origin + direction * t - point.p)));
      Vec2f u;
      EXPECT_TRUE(invertPrimitive(s.shapes, id, point.p, u, &time));
      // Embree finds it at the same distance: not a bit nearer, and not a bit farther.
      const float slack = 2e-5f * s.bounds.radius;
      EXPECT_FALSE(s.tracer->intersect({origin}, direction, 0, t - slack, time).valid());
      EXPECT_EQ(s.tracer->intersect({origin}, direction, t - slack, t + slack, time), id);
    }
    EXPECT_GT(hits, 1500);
    EXPECT_LT(worst, 1e-5 * double(s.bounds.radius));
  }
}

// Rays that leave the surface at the same time don't hit it where they start.
TEST(MovingShapes, NoSelfIntersection) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron(0, 0));
  const Scene s = folder.read(
      scene(shape("obj", std::string("<string name=\"filename\" value=\"a.obj\"/>") + kTurn)));
  Random random(8, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const float time = random.uniform();
    const PrimitiveId id{0, random.next() % 4};
    const auto point =
        samplePrimitive<float>(s.shapes, id, random.uniform(), random.uniform(), &time);
    // The tetrahedron is convex: outwards nothing is in the way.
    const auto& mesh = std::get<MovingMesh>(s.shapes[0].geometry);
    Vec3f middle(0);
    const detail::MeshAtMoment<float> view(mesh, time);
    for (unsigned k = 0; k < 4; ++k) middle += view.position(k) * 0.25f;
    const Vec3f out = dot(point.ng, point.p - middle) < 0 ? -point.ng : point.ng;
    EXPECT_TRUE(s.tracer->escapes(point.end(), out, time));
  }
}

// The steps stay as near to the keyframes' motion as they say.
TEST(MovingShapes, NearTheKeyframes) {
  const SceneFolder folder;
  const Scene s = folder.read(scene(shape("cube", kTurn)));
  const auto& mesh = std::get<MovingMesh>(s.shapes[0].geometry);
  EXPECT_GT(mesh.segments, 8);
  ASSERT_EQ(mesh.vertices(), 24u);
  for (int i = 0; i <= 100; ++i) {
    const std::string at = std::to_string(i / 100.0);
    const Scene still =
        folder.read(scene(shape("cube", kTurn), std::string(at).append(" ").append(at)));
    EXPECT_FALSE(still.moving);
    const auto& exact = std::get<TriangleMesh>(still.shapes[0].geometry);
    const detail::MeshAtMoment<float> view(mesh, static_cast<float>(i) / 100);
    for (unsigned k = 0; k < 24; ++k) {
      EXPECT_LT(glm::length(view.position(k) - exact.positions[k]), 3.8f * 6e-4f);
      EXPECT_LT(glm::length(glm::normalize(view.normal(k)) - exact.normals[k]), 2e-3f);
    }
  }
}

TEST(MovingShapes, DeformInStraightLines) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron(0, 0));
  folder.write("b.obj", tetrahedron(2, 0));
  folder.write("c.obj", tetrahedron(2, 1.5));
  const std::string states = shape("obj", "<string name=\"filename\" value=\"a.obj\"/>") +
                             shape("obj", "<string name=\"filename\" value=\"b.obj\"/>") +
                             shape("obj", "<string name=\"filename\" value=\"c.obj\"/>");
  const auto firstVertex = [](const Scene& s, float time) {
    return detail::MeshAtMoment<float>(std::get<MovingMesh>(s.shapes[0].geometry), time)
        .position(0);
  };
  const Scene whole = folder.read(scene(shape("deforming", states), "3 5"));
  EXPECT_EQ(whole.shapes[0].motionSegments(), 2);
  EXPECT_LT(glm::length(firstVertex(whole, 0.25f) - Vec3f(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(firstVertex(whole, 0.75f) - Vec3f(2, 0.75f, 0)), 1e-6f);
  const std::string times =
      R"(<float name="startTime" value="0"/><float name="endTime" value="4"/>)";
  const Scene part = folder.read(scene(shape("deforming", times + states), "1 3"));
  EXPECT_EQ(part.shapes[0].motionSegments(), 2);
  EXPECT_LT(glm::length(firstVertex(part, 0) - Vec3f(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(firstVertex(part, 1) - Vec3f(2, 0.75f, 0)), 1e-6f);
  const Scene still = folder.read(scene(shape("deforming", times + states), "1 1"));
  EXPECT_FALSE(still.moving);
  EXPECT_LT(
      glm::length(std::get<TriangleMesh>(still.shapes[0].geometry).positions[0] - Vec3f(1, 0, 0)),
      1e-6f);
}

TEST(MovingScene, Read) {
  const SceneFolder folder;
  const Scene s = folder.read(halfMovingScene(0, 1, true));
  EXPECT_TRUE(s.moving);
  EXPECT_TRUE(s.camera.moves());
  const auto moves = [&](std::size_t i) { return s.shapes[i].moves(); };
  EXPECT_FALSE(moves(0));
  EXPECT_FALSE(moves(1));
  EXPECT_FALSE(moves(2));
  for (std::size_t i = 3; i < 7; ++i) EXPECT_TRUE(moves(i)) << s.shapes[i].name;
  const Scene still = folder.read(halfMovingScene(0.4, 0.4, true));
  EXPECT_FALSE(still.moving);
  EXPECT_FALSE(still.camera.moves());
  EXPECT_FALSE(still.notes.empty());  // that the shutter does not open
  // In snake_case, with keyframes out of order.
  const Scene snake = folder.read(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"shutter_close\" "
      "value=\"2\"/></sensor><shape type=\"sphere\"><animation name=\"to_world\"><transform "
      "time=\"2\">"
      "<translate x=\"4\"/></transform><transform time=\"0\"/></animation></shape>" +
      std::string(kLight) + "</scene>");
  const auto& sphere = std::get<MovingSphere>(snake.shapes[0].geometry);
  ASSERT_EQ(sphere.steps.size(), 2u);
  EXPECT_EQ(sphere.steps[0].center, Vec3f(0));
  EXPECT_EQ(sphere.steps[1].center, Vec3f(4, 0, 0));
  EXPECT_GE(snake.bounds.radius, 3.f);
}

TEST(MovingScene, Mistakes) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron(0, 0));
  folder.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto says = [&](const std::string& body, const std::string& what) {
    const std::string message = folder.error(scene(body));
    EXPECT_NE(message.find(what), std::string::npos) << body << "\n" << message;
  };
  const auto animation = [](const std::string& keyframes) {
    return "<animation name=\"toWorld\">" + keyframes + "</animation>";
  };
  const std::string a = shape("obj", "<string name=\"filename\" value=\"a.obj\"/>");
  const std::string other = shape("obj", "<string name=\"filename\" value=\"other.obj\"/>");
  says(shape("sphere", animation(R"(<transform time="1"/>
                                    <transform time="1"><scale value="2"/></transform>)")),
       "a second keyframe at the same time");
  says(shape("cube", animation(R"(<transform time="0"/>
                                  <transform time="1"><scale x="-1"/></transform>)")),
       "one keyframe mirrors and another does not");
  says(shape("cube", animation(R"(<transform><translate x="1"/></transform>)")), "time");
  says(shape("cube", animation("")), "without keyframes");
  says("<emitter type=\"spot\">" + animation(R"(<transform time="0"/>
                                                <transform time="1"><translate x="2"/></transform>)") +
           "</emitter>",
       "can't move");
  says(shape("deforming", a), "needs two states");
  says(shape("deforming", a + other), "does not fit the first");
  says(shape("deforming", a + shape("sphere", "")), "can't deform");
  says(shape("deforming", a + shape("cube", kTurn)), "<animation> inside a deforming shape");
  says(shape("deforming", a + a + R"(<float name="startTime" value="2"/>)"), "after startTime");
  says(shape("deforming", a + shape("deforming", a + a)), "inside a deforming shape");
}

}  // namespace
}  // namespace h2mc::test
