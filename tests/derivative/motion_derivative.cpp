// SPDX-License-Identifier: MIT
// Derivatives with respect to time: of moving surfaces and lights, and of whole paths in a scene in which
// everything that can moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "derivative_check.h"
#include "geometry_cases.h"
#include "motion_scenes.h"
#include "render/core/index.h"
#include "render/path/bidirectional.h"
#include "render/path/derivative.h"
#include "render/path/replay.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

// Two poses, a quarter turn apart and of different size, with `segments` steps.
template <class At>
void forSteps(int segments, At&& at) {
  for (int i = 0; i <= segments; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(segments);
    const float angle = 1.5f * share;
    const glm::mat3 turn(std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0,
                         0, 0, 1);
    at(turn * tilt(), 1 + 0.5f * share, Vec3f(0.8f, -0.3f, 0.5f) * share);
  }
}

std::vector<Shape> movingShapes() {
  const auto mesh = [](const Shape& shape) {
    const auto& still = std::get<TriangleMesh>(shape.geometry);
    MovingMesh moving;
    moving.segments = 3;
    moving.triangles = still.triangles;
    moving.parallelogram = still.parallelogram;
    forSteps(3, [&](const glm::mat3& m, float scale, const Vec3f& by) {
      const Shape step = moved(shape, m, scale, by);
      const auto& at = std::get<TriangleMesh>(step.geometry);
      moving.positions.insert(moving.positions.end(), at.positions.begin(), at.positions.end());
      moving.normals.insert(moving.normals.end(), at.normals.begin(), at.normals.end());
    });
    return Shape{shape.name, std::move(moving)};
  };
  MovingSphere movingSphere;
  MovingDisk movingDisk;
  forSteps(3, [&](const glm::mat3& m, float scale, const Vec3f& by) {
    Sphere step = std::get<Sphere>(moved(sphere(Vec3f(0.2f, 0, 0), 0.9f), m, scale, by).geometry);
    step.toLocal = glm::transpose(m);
    movingSphere.steps.push_back(step);
    movingDisk.steps.push_back(std::get<Disk>(
        moved(disk(Vec3f(0), Vec3f(1, 0, 0), Vec3f(0.2f, 0.8f, 0)), m, scale, by).geometry));
  });
  return {mesh(cube()),
          mesh(ball(4, true)),
          mesh(parallelogram(Vec3f(-1, -1, 0), Vec3f(2, 0, 0.3f), Vec3f(0.3f, 2, 0))),
          {"sphere", movingSphere},
          {"disk", movingDisk}};
}

// The sphere's coordinates are not those of the moment only: a triangle's normals and frames depend on
// time through every corner.
TEST(MotionDerivatives, Intersection) {
  const std::vector<Shape> shapes = movingShapes();
  Random random(2, 0, 0);
  for (unsigned i = 0; i < shapes.size(); ++i) {
    SCOPED_TRACE(shapes[i].name);
    int seen = 0;
    for (int k = 0; k < 400 && seen < 10; ++k) {
      const double time = 0.02 + 0.96 * random.uniformDouble();
      if (std::abs(time * 3 - std::round(time * 3)) < 0.05) continue;  // at the border of two steps
      const float at = static_cast<float>(time);
      const PrimitiveId id{i, shapes[i].isMesh() ? random.next() % 2 : 0};
      const auto p = samplePrimitive<float>(shapes, id, random.uniform(), random.uniform(), &at);
      const Vec3f from = p.p + randomDirection(random) * 4.f;
      const Vec3f along = glm::normalize(p.p - from);
      if (std::abs(dot(along, p.ng)) < 0.3f) continue;
      if (shapes[i].name == "sphere" && dot(along, p.ng) > 0) continue;  // the nearer root
      ++seen;
      const auto f = [&]<class T>(const std::array<T, 4>& x) {
        using S = Scalar<T>;
        const Vec3<S> o(from), d(along);
        const Vec3<T> origin{x[0] + o.x, T(o.y), T(o.z)};
        const Vec3<T> direction = ad::normalize(Vec3<T>(T(d.x), x[1] + d.y, x[2] + d.z));
        return test::outputs<T>(intersectPrimitive<T>(shapes, id, origin, direction, &x[3]));
      };
      EXPECT_GT(expectDerivatives<4>(f, {0, 0, 0, time}, 1e-3, 5e-2), 0.8);
    }
    EXPECT_EQ(seen, 10);
  }
}

TEST(MotionDerivatives, SamplingAndArea) {
  const std::vector<Shape> shapes = movingShapes();
  Random random(3, 0, 0);
  for (unsigned i = 0; i < shapes.size(); ++i) {
    SCOPED_TRACE(shapes[i].name);
    for (int k = 0; k < 8; ++k) {
      const std::array<double, 3> x{0.05 + 0.9 * random.uniformDouble(),
                                    0.05 + 0.9 * random.uniformDouble(),
                                    (0.1 + 0.8 * random.uniformDouble() + k % 3) / 3};
      const auto f = [&]<class T>(const std::array<T, 3>& u) {
        std::vector<T> r = test::outputs<T>(samplePrimitive<T>(shapes, {i, 0}, u[0], u[1], &u[2]));
        r.push_back(primitiveAreaAt<T>(shapes[i], 0, &u[2]));
        return r;
      };
      EXPECT_GT(expectDerivatives<3>(f, x, 1e-3, 5e-2), 0.8);
      // The map's Jacobian is the area at that time.
      using D = ad::Dual2<double, 2>;
      const D time(x[2]);
      const auto s =
          samplePrimitive<D>(shapes, {i, 0}, D::variable(x[0], 0), D::variable(x[1], 1), &time);
      const auto column = [&](int c) {
        return glm::dvec3(s.p.x.gradient(c), s.p.y.gradient(c), s.p.z.gradient(c));
      };
      EXPECT_NEAR(glm::length(glm::cross(column(0), column(1))) /
                      primitiveAreaAt<double>(shapes[i], 0, &x[2]),
                  1, 1e-6);
    }
  }
}

TEST(MotionDerivatives, AreaLights) {
  Random random(4, 0, 0);
  for (const Shape& shape : movingShapes()) {
    SCOPED_TRACE(shape.name);
    const std::vector<Shape> shapes{shape};
    AreaLight light;
    light.radiance = constantTexture(Rgbf(1, 2, 3));
    light.shape = 0;
    light.prepare(shapes);
    const LightContext context{shapes, {Vec3f(0), 5}};
    int lit = 0;
    for (int k = 0; k < 400 && lit < 8; ++k) {
      const PrimitiveId id = light.choosePrimitive(context, random.uniform());
      const double time = (0.1 + 0.8 * random.uniformDouble() + k % 3) / 3;
      const Vec3f reference = randomDirection(random) * 5.f;
      const double u0 = 0.1 + 0.8 * random.uniformDouble(), u1 = 0.1 + 0.8 * random.uniformDouble();
      const auto direct = [&]<class T>(const std::array<T, 4>& x) {
        const Vec3<Scalar<T>> r(reference);
        const auto d = light.sampleDirect<T>(context, id, Vec3<T>(x[0] + r.x, T(r.y), T(r.z)), x[1],
                                             x[2], &x[3]);
        std::vector<T> out{d.distance, d.directPdf, d.emissionPdf, d.cosLight};
        append(out, d.direction);
        append(out, d.arriving);
        return out;
      };
      const auto values = direct.operator()<double>({0, u0, u1, time});
      if (!(values[2] > 0) || values[3] < 0.2) continue;
      ++lit;
      EXPECT_GT(expectDerivatives<4>(direct, {0, u0, u1, time}, 1e-3, 5e-2), 0.8);
      const auto emitted = [&]<class T>(const std::array<T, 5>& x) {
        const auto e = light.sampleEmission<T>(context, id, x[0], x[1], x[2], x[3], &x[4]);
        std::vector<T> out{e.directPdf, e.emissionPdf, e.cosLight};
        append(out, e.origin);
        append(out, e.direction);
        append(out, e.normal);
        return out;
      };
      EXPECT_GT(expectDerivatives<5>(emitted, {u0, u1, 0.4, 0.3, time}, 1e-3, 5e-2), 0.8);
      // Hitting the light reckons with the density with which it is sampled, choice included.
      const float at = static_cast<float>(time);
      const auto e = light.sampleEmission<float>(context, id, static_cast<float>(u0),
                                                 static_cast<float>(u1), 0.4f, 0.3f, &at);
      const auto p =
          samplePrimitive<float>(shapes, id, static_cast<float>(u0), static_cast<float>(u1), &at);
      const auto hit = light.hit<float>(context, p, -e.direction, id, &at);
      EXPECT_NEAR(hit.directPdf / e.directPdf, 1, 1e-5);
      EXPECT_NEAR(hit.emissionPdf / e.emissionPdf, 1, 1e-4);
      const double chosen =
          shape.isMesh() ? primitiveArea(shape, id.primitive) / totalArea(shape) : 1;
      EXPECT_NEAR(e.directPdf * primitiveAreaAt<float>(shape, id.primitive, &at) / chosen, 1, 1e-5);
    }
    EXPECT_EQ(lit, 8);
  }
}

class MovingPaths : public ::testing::TestWithParam<bool> {};

// As PathDerivative in path_derivative.cpp, with time as the last coordinate.
TEST_P(MovingPaths, SlowAgreeWithFiniteDifferences) {
  const h2mc::testing::SceneFolder folder;
  const Scene scene = folder.read(halfMovingScene(0, 1, GetParam()));
  constexpr int kMaxLength = 5;
  BidirectionalSampler sampler(kMaxLength);
  Path path(kMaxLength);
  std::map<std::pair<int, int>, int> seen;
  int judged = 0, wrong = 0, notFinite = 0, moving = 0, still = 0, timeMatters = 0;
  for (int i = 0; i < 1500; ++i) {
    Random random(5, 0, static_cast<std::uint64_t>(i));
    sampler.sample(scene, random, -1, -1, 1, [&](const BidirectionalSampler::Connection& c) {
      path.technique = c.technique;
      path.sample = sampler.primarySample(c.technique);
      ASSERT_TRUE(tracePath(scene, path));
      EXPECT_EQ(path.target, luminance(c.contribution)) << "replayed sample " << i;
      int& count = seen[{c.technique.s, 2 * c.technique.t + path.moving}];
      if (count >= (path.moving ? 8 : 2)) return;
      ++count;
      ++(path.moving ? moving : still);
      Derivative d;
      differentiate(scene, path, d);
      const int n = path.technique.dimension() + (path.moving ? 1 : 0);
      ASSERT_EQ(d.dimension, n);
      EXPECT_NEAR(d.logTarget, std::log(path.target), 1e-3);
      if (!d.finite()) {
        ++notFinite;
        return;
      }
      std::array<double, 2 * kMaxLength + 1> u{};
      std::copy_n(path.sample.u.begin(), path.technique.dimension(), u.begin());
      if (path.moving) u[at(n) - 1] = path.sample.time;
      const auto f = [&](const double* x) {
        return replayLogTarget<double>(scene, path, x, path.moving ? x + n - 1 : nullptr);
      };
      const auto fd = ad::finiteDifferences(f, u.data(), n, 1e-5);
      const auto wide = ad::finiteDifferences(f, u.data(), n, 1e-3);
      double gradientScale = 1, hessianScale = 1;
      for (int k = 0; k < n; ++k)
        gradientScale = std::max(gradientScale, double(std::abs(d.gradient[k])));
      for (int k = 0; k < n * (n + 1) / 2; ++k)
        hessianScale = std::max(hessianScale, double(std::abs(d.hessian[k])));
      if (path.moving) timeMatters += std::abs(d.gradient[n - 1]) > 0.01 * gradientScale;
      for (int a = 0, k = 0; a < n; ++a) {
        const auto& g = fd.gradient[at(a)];
        const auto& g2 = wide.gradient[at(a)];
        if (std::max(g.error, std::abs(g.value - g2.value)) <= 1e-3 * gradientScale) {
          ++judged;
          wrong += !(std::abs(d.gradient[a] - g.value) <= 1e-2 * gradientScale + 10 * g.error);
        }
        for (int b = 0; b <= a; ++b, ++k) {
          const auto entry = at(a) * static_cast<std::size_t>(n) + static_cast<std::size_t>(b);
          const auto& h = fd.hessian[entry];
          const auto& h2 = wide.hessian[entry];
          if (std::max(h.error, std::abs(h.value - h2.value)) <= 1e-2 * hessianScale) {
            ++judged;
            wrong += !(std::abs(d.hessian[k] - h.value) <= 2e-2 * hessianScale + 10 * h.error);
          }
        }
      }
    });
  }
  std::printf("%d moving and %d still paths: %d entries judged, %d wrong; %d paths not finite\n",
              moving, still, judged, wrong, notFinite);
  EXPECT_GT(moving, 20 * kMaxLength);
  EXPECT_EQ(still > 0, !GetParam()) << "where the camera moves every path depends on time";
  EXPECT_GT(timeMatters, moving / 3);
  EXPECT_GT(judged, 1000);
  EXPECT_LE(wrong, judged / 200);
  EXPECT_LE(notFinite, moving / 20);
}

INSTANTIATE_TEST_SUITE_P(Camera, MovingPaths, ::testing::Values(false, true), [](const auto& info) {
  return std::string(info.param ? "MovingCamera" : "StillCamera");
});

}  // namespace
}  // namespace h2mc::test
