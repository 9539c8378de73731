// SPDX-License-Identifier: MIT
// Points on primitives: conventions, inverses, areas.
#include <gtest/gtest.h>

#include "geometry_cases.h"

namespace h2mc {
namespace {

using namespace test;

const Vec3f kA(-0.5f, 0.7f, 1.2f), kE(1.1f, 0.2f, 0.1f), kF(-0.1f, 0.4f, -1.3f);

void expectNear(const Vec3f& a, const Vec3f& b, float tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

TEST(Surface, TriangleCoordinates) {
  std::vector<Shape> shapes{meshShape({{0, 0, 0}, {2, 0, 0}, {0, 4, 0}}, {{0, 1, 2}})};
  const auto at = [&] {
    return intersectPrimitive<float>(shapes, {0, 0}, Vec3f(0.5f, 1, 7), Vec3f(0, 0, -1));
  };
  EXPECT_EQ(at().p, Vec3f(0.5f, 1, 0));
  EXPECT_EQ(at().ng, Vec3f(0, 0, 1));
  EXPECT_EQ(at().shading.n, Vec3f(0, 0, 1));
  EXPECT_EQ(at().uv,
            Vec2f(0.25f, 0.25f));  // barycentric coordinates of the second and third corner

  auto& mesh = std::get<TriangleMesh>(shapes[0].geometry);
  mesh.uvs = {{0, 0}, {1, 0}, {1, 2}};
  EXPECT_EQ(at().uv, Vec2f(0.5f, 0.5f));
  // Shading normals below: the geometric normal goes with them.
  mesh.normals = {{0, 0, -1}, {0, 0, -1}, {0, 0.6f, -0.8f}};
  expectNear(at().shading.n, glm::normalize(Vec3f(0, 0.15f, -0.95f)), 1e-6f);
  EXPECT_EQ(at().ng, Vec3f(0, 0, -1));
  // Normals that cancel, or are zero: the geometric one.
  mesh.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, -1}};
  EXPECT_EQ(at().shading.n, Vec3f(0, 0, 1));
  mesh.normals = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(at().shading.n, Vec3f(0, 0, 1));
}

TEST(Surface, SphereCoordinates) {
  std::vector<Shape> shapes{{"sphere", Sphere{Vec3f(1, 2, 3), 2, false, glm::mat3(1)}}};
  const Vec3f o(6, 2, 3), d(-1, 0, 0);
  const auto near = intersectPrimitive<float>(shapes, {0, 0}, o, d);
  EXPECT_EQ(near.p, Vec3f(3, 2, 3));
  EXPECT_EQ(near.ng, Vec3f(1, 0, 0));
  EXPECT_EQ(near.uv, Vec2f(0, 0.5f));
  const auto far = intersectPrimitive<float>(shapes, {0, 1}, o, d);
  EXPECT_EQ(far.p, Vec3f(-1, 2, 3));
  EXPECT_NEAR(far.uv.x, 0.5f, 1e-6f);
  const auto side = intersectPrimitive<float>(shapes, {0, 0}, Vec3f(1, -9, 3), Vec3f(0, 1, 0));
  EXPECT_NEAR(side.uv.x, 0.75f, 1e-6f);
  const auto top = intersectPrimitive<float>(shapes, {0, 0}, Vec3f(1, 2, 9), Vec3f(0, 0, -1));
  EXPECT_NEAR(top.uv.y, 0, 1e-6f);
  std::get<Sphere>(shapes[0].geometry).flipNormals = true;
  EXPECT_EQ(intersectPrimitive<float>(shapes, {0, 0}, o, d).ng, Vec3f(-1, 0, 0));
}

TEST(Surface, SphereFromItsCentreAndSurface) {
  const std::vector<Shape> shapes{sphere(Vec3f(10, 20, 30), 2)};
  Random random(3, 3, 3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f d = randomDirection(random);
    expectNear(intersectPrimitive<float>(shapes, {0, 1}, Vec3f(10, 20, 30), d).p,
               Vec3f(10, 20, 30) + d * 2.0f, 1e-5f);
    const Vec3f p = samplePrimitive<float>(shapes, {0, 0}, random.uniform(), random.uniform()).p;
    const Vec3f n = (p - Vec3f(10, 20, 30)) / 2.0f;
    if (std::abs(dot(n, d)) < 0.01f) continue;
    const Vec3f expected = p - d * (4 * dot(n, d));
    const std::uint32_t root = dot(n, d) < 0;
    expectNear(intersectPrimitive<float>(shapes, {0, root}, p, d).p, expected,
               1e-5f / std::abs(dot(n, d)));
    expectNear(intersectPrimitive<float>(shapes, {0, 1 - root}, p, d).p, p, 1e-4f);
  }
}

TEST(Surface, DiskCoordinates) {
  const std::vector<Shape> shapes{disk(Vec3f(0, 0, 1), Vec3f(2, 0, 0), Vec3f(0, 2, 0))};
  const auto p = intersectPrimitive<float>(shapes, {0, 0}, Vec3f(0, -1, 5), Vec3f(0, 0, -1));
  EXPECT_EQ(p.p, Vec3f(0, -1, 1));
  EXPECT_NEAR(p.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(p.uv.y, 0.75f, 1e-6f);
  EXPECT_EQ(p.ng, Vec3f(0, 0, 1));
}

TEST(Surface, InvertGivesTheCoordinatesBack) {
  std::vector<Shape> shapes{meshShape({kA, kA + kE, kA + kF}, {{0, 1, 2}}),
                            parallelogram(kA, kE, kF), disk(kA, kE, kF), sphere(kA, 0.6f)};
  for (const float scale : {1.f, 1e-4f, 1e6f}) {
    std::vector<Shape> scaled;
    for (const Shape& s : shapes) scaled.push_back(moved(s, tilt(), scale, Vec3f(scale)));
    Random random(5, 5, 5);
    for (unsigned s = 0; s < scaled.size(); ++s)
      for (int i = 0; i < 2000; ++i) {
        const Vec2f u(random.uniform() * 0.99f, random.uniform());
        const auto point = samplePrimitive<float>(scaled, {s, 0}, u.x, u.y);
        Vec2f back;
        ASSERT_TRUE(invertPrimitive(scaled, {s, 0}, point.p, back));
        // An angle may come back from the other side of 0.
        float turn = std::abs(back.y - u.y);
        if (wrapsAround(scaled[s])) turn = std::min(turn, 1 - turn);
        ASSERT_NEAR(back.x, u.x, 1e-5f);
        ASSERT_LT(turn * std::sqrt(std::min({u.x, 1 - u.x, 0.1f})), 1e-5f);
        ASSERT_GE(back.y, 0);
        ASSERT_LT(back.y, 1);
        EXPECT_FALSE(invertPrimitive(scaled, {s, 0}, point.p + point.ng * (scale * 0.1f), back));
      }
  }
  Vec2f u;
  EXPECT_FALSE(invertPrimitive(shapes, {0, 0}, kA + (kE + kF) * 0.6f, u));
  EXPECT_FALSE(invertPrimitive(shapes, {1, 0}, kA + kE * 1.1f, u));
}

TEST(Surface, ParallelogramIsOneSurface) {
  const std::vector<Shape> shapes{parallelogram(kA, kE, kF)};
  Random random(5, 6, 5);
  for (int i = 0; i < 1000; ++i) {
    const float u0 = random.uniform(), u1 = random.uniform();
    expectNear(samplePrimitive<float>(shapes, {0, 0}, u0, u1).p, kA + kE * u0 + kF * u1, 1e-6f);
  }
}

TEST(Surface, Areas) {
  EXPECT_NEAR(totalArea(cube()), 24, 1e-6);
  EXPECT_NEAR(primitiveArea(cube(), 3), 2, 1e-6);
  EXPECT_NEAR(totalArea(sphere(Vec3f(3), 2)), 16 * M_PI, 1e-6);
  EXPECT_NEAR(totalArea(disk(kA, Vec3f(2, 0, 0), Vec3f(1, 3, 0))), 6 * M_PI, 1e-6);
  EXPECT_NEAR(primitiveArea(parallelogram(kA, Vec3f(2, 0, 0), Vec3f(1, 3, 0)), 0), 6, 1e-6);
  EXPECT_EQ(primitiveArea(meshShape({kA, kA, kA}, {{0, 1, 2}}), 0), 0);
}

// Points found from far away are as near to the surface as float can say.
TEST(Surface, PointsLieOnTheSurface) {
  const std::vector<Shape> shapes{
      moved(meshShape({{-900, -700, 0}, {800, -900, 0}, {30, 990, 0}}, {{0, 1, 2}}), tilt(), 1,
            Vec3f(0.3f, 0.2f, 0.1f)),
      sphere(Vec3f(600, -800, 1), 1000)};
  Random random(5, 6, 7);
  for (unsigned s = 0; s < 2; ++s)
    for (int i = 0; i < 2000; ++i) {
      const Vec3f target = randomPoint(random), d = randomDirection(random);
      const Vec3f origin = target - d * (2000 * random.uniform());
      const std::uint32_t root =
          s == 1 && dot(target - Vec3f(600, -800, 1), d) > 0;  // the one near the target
      const auto p = intersectPrimitive<float>(shapes, {s, s ? root : 0}, origin, d);
      if (glm::length(p.p) > 10 || std::abs(dot(p.ng, d)) < 0.01f) continue;
      double off;
      if (s == 1) {
        off = std::abs(glm::length(glm::dvec3(p.p) - glm::dvec3(600, -800, 1)) - 1000);
      } else {
        const auto& mesh = std::get<TriangleMesh>(shapes[0].geometry);
        const glm::dvec3 a(mesh.positions[0]), b(mesh.positions[1]), c(mesh.positions[2]);
        off = std::abs(glm::dot(glm::normalize(glm::cross(b - a, c - a)), glm::dvec3(p.p) - a));
      }
      ASSERT_LT(off, 1e-6);  // half an ulp of 8 in each coordinate
    }
}

}  // namespace
}  // namespace h2mc
