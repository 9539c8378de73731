// SPDX-License-Identifier: MIT
// Instances against the same shapes written out.
#include <gtest/gtest.h>

#include "render/core/random.h"
#include "render/geometry/ray_tracer.h"
#include "render/geometry/surface.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

// A mesh with normals and texture coordinates, without any symmetry.
const char* const kObj =
    "v 0 0 0\nv 1 0.1 0\nv 0.2 0.9 0.1\nv 0.3 0.2 0.8\n"
    "vt 0 0\nvt 1 0\nvt 0.2 0.9\nvt 0.6 0.5\n"
    "vn -0.5 -0.6 -0.6\nvn 0.8 -0.5 -0.2\nvn 0 0.9 -0.2\nvn 0 0.1 0.9\n"
    "f 1/1/1 3/3/3 2/2/2\nf 1/1/1 2/2/2 4/4/4\nf 2/2/2 3/3/3 4/4/4\nf 3/3/3 1/1/1 4/4/4\n";

std::string obj(const std::string& inside) {
  return "<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/>" + inside + "</shape>";
}
std::string toWorld(const std::string& operations) {
  return "<transform name=\"toWorld\">" + operations + "</transform>";
}
std::string moving(const std::string& first, const std::string& second) {
  const auto key = [](const std::string& time, const std::string& operations) {
    return "<transform time=\"" + time + "\">" + operations + "</transform>";
  };
  return "<animation name=\"toWorld\">" + key("0", first) + key("1", second) + "</animation>";
}
std::string group(const std::string& shapes) {
  return "<shape type=\"shapegroup\" id=\"g\">" + shapes + "</shape>";
}
std::string instance(const std::string& where) {
  return "<shape type=\"instance\"><ref id=\"g\"/>" + where + "</shape>";
}

const std::string kTurn =
    "<scale x=\"1.2\" y=\"0.6\"/><rotate y=\"1\" z=\"0.4\" angle=\"70\"/>"
    "<translate x=\"0.6\" z=\"0.8\"/>";
const std::string kMirror = "<scale x=\"-1\"/><rotate x=\"1\" angle=\"30\"/><translate y=\"0.3\"/>";
const std::string kEven =
    "<scale value=\"1.4\"/><rotate z=\"1\" angle=\"35\"/><translate x=\"0.2\"/>";

std::string scene(const std::string& shapes) {
  return "<scene version=\"0.6.0\"><sensor type=\"perspective\">"
         "<float name=\"shutterOpen\" value=\"0\"/><float name=\"shutterClose\" "
         "value=\"1\"/></sensor>" +
         shapes + "<emitter type=\"constant\"/></scene>";
}

// Random rays meet the same point, normals and coordinates in both scenes.
void expectSame(const Scene& a, const Scene& b, float tolerance) {
  Random random(5, 6, 7);
  int hits = 0, borders = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto point = [&](float size) {
      const float x = random.uniform(), y = random.uniform(), z = random.uniform();
      return Vec3f(x - 0.5f, y - 0.5f, z - 0.5f) * size + Vec3f(0.4f, 0.4f, 0.4f);
    };
    const Vec3f origin = point(8), direction = glm::normalize(point(2) - origin);
    const float time = random.uniform();
    const PrimitiveId inA = a.tracer->intersect({origin}, direction, 0, RayTracer::kFar, time);
    const PrimitiveId inB = b.tracer->intersect({origin}, direction, 0, RayTracer::kFar, time);
    if (inA.valid() != inB.valid()) {
      ++borders;
      continue;
    }
    if (!inA.valid()) {
      EXPECT_TRUE(a.tracer->escapes({origin}, direction, time));
      continue;
    }
    const auto pointOf = [&](const Scene& s, PrimitiveId id) {
      return intersectPrimitive<float>(s.shapes, id, origin, direction, &time);
    };
    const SurfacePoint<float> p = pointOf(a, inA), q = pointOf(b, inB);
    // On the other side of an edge.
    if (glm::length(p.p - q.p) > 0.05f || glm::length(p.ng - q.ng) > 100 * tolerance) {
      ++borders;
      continue;
    }
    ++hits;
    EXPECT_LT(glm::length(p.p - q.p), tolerance);
    EXPECT_LT(glm::length(p.shading.n - q.shading.n), 100 * tolerance);
    EXPECT_LT(glm::length(p.uv - q.uv), 100 * tolerance);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(borders, hits / 300);
}

class Instances : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("m.obj", kObj); }
  Scene read(const std::string& shapes) { return folder_.read(scene(shapes)); }
  SceneFolder folder_;
};

TEST_F(Instances, AreTheShapesWrittenOut) {
  for (const std::string& where : {kTurn, kEven})
    expectSame(read(group(obj("")) + instance(toWorld(where))), read(obj(toWorld(where))), 4e-6f);
}

// The side of a normal stays what it is in the group; a mesh that is mirrored itself may turn.
TEST_F(Instances, MirroredKeepTheSideOfTheirNormals) {
  const Scene s = read(group(obj("")) + instance(toWorld(kMirror)));
  const Scene plain = read(obj(""));
  const Placement& placement = s.shapes[0].placements()[0];
  EXPECT_TRUE(placement.mirrors());
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto a = samplePrimitive<float>(plain.shapes, {0, i}, 0.4f, 0.3f);
    const auto b = detail::triangleOf(
        detail::StillMesh<float>(std::get<MeshInstance>(s.shapes[0].geometry)), i);
    EXPECT_LT(glm::length(Vec3f(placement.normal(a.ng)) - b.normal), 1e-5f);
  }
}

TEST_F(Instances, MoveAsTheShapesDo) {
  const std::string motion =
      moving(kTurn, kTurn + "<rotate z=\"1\" angle=\"40\"/><translate x=\"0.7\"/>");
  const Scene instances = read(group(obj("")) + instance(motion));
  ASSERT_TRUE(instances.moving);
  EXPECT_GT(instances.shapes[0].motionSegments(), 1);
  // Their boxes differ, and so may the number of steps: both are within the chord error.
  expectSame(instances, read(obj(motion)), 4e-3f);
}

TEST_F(Instances, OfSpheresDisksAndCylinders) {
  const std::string sphere =
      "<shape type=\"sphere\"><point name=\"center\" x=\"0.2\" y=\"0.4\" z=\"0\"/>"
      "<float name=\"radius\" value=\"0.5\"/>";
  const std::string disk = "<shape type=\"disk\">";
  const std::string cylinder = "<shape type=\"cylinder\"><float name=\"radius\" value=\"0.4\"/>";
  for (const std::string& shape : {sphere, disk, cylinder})
    expectSame(read(group(shape + "</shape>") + instance(toWorld(kEven))),
               read(shape + toWorld(kEven) + "</shape>"), 4e-6f);
  expectSame(read(group(disk + "</shape>") + instance(toWorld(kTurn))),
             read(disk + toWorld(kTurn) + "</shape>"), 4e-6f);
}

// A sphere that becomes an ellipsoid is a fine mesh.
TEST_F(Instances, EllipsoidsLieOnTheirSurface) {
  const Scene s =
      read(group("<shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/></shape>") +
           instance(toWorld("<scale x=\"2\" y=\"1\" z=\"0.5\"/><translate x=\"0.4\"/>")));
  Random random(1, 2, 3);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const float x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3f origin = Vec3f(x - 0.5f, y - 0.5f, z - 0.5f) * 6.f;
    const Vec3f direction = glm::normalize(Vec3f(0.4f, 0, 0) - origin);
    const PrimitiveId id = s.tracer->intersect({origin}, direction);
    if (!id.valid()) continue;
    ++hits;
    const auto p = intersectPrimitive<float>(s.shapes, id, origin, direction);
    const Vec3f q = (p.p - Vec3f(0.4f, 0, 0)) / Vec3f(1, 0.5f, 0.25f);
    EXPECT_NEAR(glm::length(q), 1, 5e-4f);
    const Vec3f n = glm::normalize(q / Vec3f(1, 0.5f, 0.25f));
    EXPECT_GT(dot(n, p.shading.n), 0.9999f);
  }
  EXPECT_GT(hits, 4000);
}

// A hundred of them have one mesh.
TEST_F(Instances, ShareTheirMesh) {
  std::string many = group(obj(""));
  for (int i = 0; i < 100; ++i)
    many += instance(toWorld("<translate x=\"" + std::to_string(i) + "\"/>"));
  const Scene s = read(many);
  ASSERT_EQ(s.shapes.size(), 100u);
  for (const Shape& shape : s.shapes) EXPECT_EQ(shape.sharedMesh(), s.shapes[0].sharedMesh());
}

// Rays that leave an instance don't meet it again.
TEST_F(Instances, AreLeftByRays) {
  const Scene s = read(group(obj("")) + instance(toWorld("<scale x=\"30\" y=\"1\" z=\"5\"/>"
                                                         "<rotate x=\"1\" y=\"2\" angle=\"50\"/>"
                                                         "<translate x=\"300\" y=\"-200\"/>")));
  Random random(3, 4, 5);
  int left = 0, again = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto triangle = static_cast<std::uint32_t>(random.uniform() * 4);
    const float u = random.uniform(), v = random.uniform(), x = random.uniform(),
                y = random.uniform(), z = random.uniform();
    const auto view = detail::StillMesh<float>(std::get<MeshInstance>(s.shapes[0].geometry));
    const auto p = detail::sampleTriangle<float>(view, triangle, u, v);
    Vec3f direction = glm::normalize(Vec3f(x - 0.5f, y - 0.5f, z - 0.5f));
    // A tetrahedron is convex: outwards nothing is met.
    const auto t = detail::triangleOf(view, triangle);
    if (dot(direction, t.normal) < 0) direction = -direction;
    if (dot(direction, t.normal) < 0.01f) continue;
    ++left;
    again += s.tracer->intersect({p.p, t.normal, 0}, direction).valid();
  }
  EXPECT_GT(left, 10000);
  EXPECT_EQ(again, 0);
}

}  // namespace
}  // namespace h2mc
