// SPDX-License-Identifier: MIT
// Derivatives of points on surfaces, and densities as Jacobians.
#include <gtest/gtest.h>

#include "derivative_check.h"
#include "geometry_cases.h"
#include "render/geometry/ray_tracer.h"

namespace h2mc {
namespace {

using namespace test;

std::vector<Shape> everyShape() {
  const Vec3f a(-0.5f, 0.7f, 1.2f), e(1.1f, 0.2f, 0.1f), f(-0.1f, 0.4f, -1.3f);
  std::vector<Shape> shapes;
  shapes.push_back(meshShape({a, a + e, a + f}, {{0, 1, 2}}));
  Shape textured = meshShape({a, a + e, a + f}, {{0, 1, 2}});
  auto& mesh = std::get<TriangleMesh>(textured.geometry);
  mesh.uvs = {{0.1f, 0.9f}, {2, 0.3f}, {-1, 0}};
  mesh.normals = {glm::normalize(Vec3f(0.1f, 1, 0.2f)), glm::normalize(Vec3f(0.5f, 0.8f, 0)),
                  glm::normalize(Vec3f(-0.3f, 1, 0.4f))};
  shapes.push_back(textured);
  for (Vec3f& n : mesh.normals) n = -n;
  shapes.push_back(textured);
  shapes.push_back(parallelogram(a, e, f));
  shapes.push_back(disk(a, e, f));
  shapes.push_back(sphere(a, 0.6f));
  shapes.push_back(sphere(Vec3f(0.1f, 0.1f, 0), 4, true));
  shapes.push_back(cylinder(a, a + e, 0.5f));
  shapes.push_back(cylinder(a, a + f * 2.0f, 0.7f, true));
  return shapes;
}

TEST(SurfaceDerivatives, Intersection) {
  const std::vector<Shape> shapes = everyShape();
  Random random(1, 1, 1);
  std::vector<int> seen(shapes.size());
  for (unsigned i = 0; i < shapes.size(); ++i) {
    const RayTracer alone(std::span<const Shape>(shapes).subspan(i, 1));
    for (int k = 0; k < 5000 && seen[i] < 12; ++k) {
      const Vec3f o = randomPoint(random) * 2.0f, d = randomDirection(random);
      PrimitiveId id = alone.intersect({o}, d);
      if (!id.valid()) continue;
      id.shape = i;
      const float cosine = dot(intersectPrimitive<float>(shapes, id, o, d).ng, d);
      if (std::abs(cosine) < 0.2f) continue;
      ++seen[i];
      const Frame<float> frame = Frame<float>::fromNormal(d);
      const auto f = [&]<class T>(const std::array<T, 5>& x) {
        const Vec3<T> origin = Vec3<T>(x[0], x[1], x[2]) + plain<T>(o);
        const Vec3<T> direction =
            ad::normalize(plain<T>(frame.s) * x[3] + plain<T>(frame.t) * x[4] + plain<T>(d));
        return test::outputs<T>(intersectPrimitive<T>(shapes, id, origin, direction));
      };
      const double share = expectDerivatives<5>(f, {0, 0, 0, 0, 0});
      EXPECT_GT(share, 0.8) << shapes[i].name << " " << i;
    }
    EXPECT_EQ(seen[i], 12) << shapes[i].name << " " << i;
  }
}

// The area of the parallelogram of a point's derivatives.
template <class D>
double areaElement(const Vec3<D>& p, int i, int j) {
  const glm::dvec3 a(p.x.gradient(i), p.y.gradient(i), p.z.gradient(i)),
      b(p.x.gradient(j), p.y.gradient(j), p.z.gradient(j));
  return glm::length(glm::cross(a, b));
}

TEST(SurfaceDerivatives, Sampling) {
  const std::vector<Shape> shapes = everyShape();
  Random random(1, 1, 2);
  for (unsigned i = 0; i < shapes.size(); ++i)
    for (int k = 0; k < 12; ++k) {
      const std::array<double, 2> u{0.02 + 0.96 * random.uniformDouble(),
                                    0.02 + 0.96 * random.uniformDouble()};
      const auto f = [&]<class T>(const std::array<T, 2>& x) {
        return test::outputs<T>(samplePrimitive<T>(shapes, {i, 0}, x[0], x[1]));
      };
      EXPECT_GT(expectDerivatives<2>(f, u), 0.8) << i;
      using D = ad::Dual2<double, 2>;
      const SurfacePoint<D> s =
          samplePrimitive<D>(shapes, {i, 0}, D::variable(u[0], 0), D::variable(u[1], 1));
      EXPECT_NEAR(areaElement(s.p, 0, 1) / primitiveArea(shapes[i], 0), 1, 1e-6)
          << shapes[i].name << " " << i;
    }
}

// Coordinates where the maps are singular: corners, poles, centres.
TEST(SurfaceDerivatives, FiniteAtTheBorder) {
  const std::vector<Shape> shapes = everyShape();
  const float ends[] = {0, 1e-30f, 1e-20f, 1e-12f, 1e-9f, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
  for (unsigned i = 0; i < shapes.size(); ++i)
    for (const float u0 : ends)
      for (const float u1 : ends) {
        using D = ad::Dual2<float, 2>;
        const SurfacePoint<D> s =
            samplePrimitive<D>(shapes, {i, 0}, D::variable(u0, 0), D::variable(u1, 1));
        for (const D& x : test::outputs<D>(s))
          EXPECT_TRUE(isFinite(x)) << shapes[i].name << " " << i << " at " << u0 << ", " << u1;
      }
}

}  // namespace
}  // namespace h2mc
