// SPDX-License-Identifier: MIT
// Lights through the AD type: derivatives against finite differences, densities as Jacobians.
#include <gtest/gtest.h>

#include "derivative_check.h"
#include "light_cases.h"
#include "render/core/index.h"
#include "render/geometry/ray_tracer.h"

namespace h2mc {
namespace {

using namespace test;

template <class T>
std::vector<T> outputs(const DirectLight<T>& r) {
  std::vector<T> out{r.distance, r.directPdf, r.emissionPdf, r.cosLight};
  append(out, r.direction);
  append(out, r.arriving);
  return out;
}
template <class T>
std::vector<T> outputs(const EmittedRay<T>& r) {
  std::vector<T> out{r.directPdf, r.emissionPdf, r.cosLight};
  append(out, r.origin);
  append(out, r.direction);
  append(out, r.normal);
  append(out, r.flux);
  return out;
}
template <class T>
std::vector<T> outputs(const LightHit<T>& r) {
  std::vector<T> out{r.directPdf, r.emissionPdf};
  append(out, r.radiance);
  return out;
}

double inner(Random& random) { return 0.03 + 0.94 * random.uniformDouble(); }

const Vec3f kReference(0.2f, -0.4f, 0.3f);

TEST(LightDerivatives, Direct) {
  for (const LightCase& c : allCases()) {
    Random random(1, 2, 3);
    double share = 0;
    for (int k = 0; k < 10; ++k) {
      const std::array<double, 5> x{inner(random), inner(random), 0, 0, 0};
      const PrimitiveId id =
          with(c, [&](const auto& l) { return l.choosePrimitive(c.context(), random.uniform()); });
      share += expectDerivatives<5>(
          [&]<class T>(const std::array<T, 5>& u) {
            const Vec3<T> reference = Vec3<T>(u[2], u[3], u[4]) + plain<T>(kReference);
            return with(c, [&](const auto& l) {
              return outputs<T>(l.template sampleDirect<T>(c.context(), id, reference, u[0], u[1]));
            });
          },
          x, 2e-4);
      if (testing::Test::HasFailure()) {
        FAIL() << c.name;
      }
    }
    EXPECT_GT(share / 10, 0.7) << c.name;
  }
}

TEST(LightDerivatives, Emission) {
  for (const LightCase& c : allCases()) {
    Random random(1, 2, 4);
    double share = 0;
    for (int k = 0; k < 10; ++k) {
      const std::array<double, 4> x{inner(random), inner(random), inner(random), inner(random)};
      const PrimitiveId id =
          with(c, [&](const auto& l) { return l.choosePrimitive(c.context(), random.uniform()); });
      share += expectDerivatives<4>(
          [&]<class T>(const std::array<T, 4>& u) {
            return with(c, [&](const auto& l) {
              return outputs<T>(
                  l.template sampleEmission<T>(c.context(), id, u[0], u[1], u[2], u[3]));
            });
          },
          x, 2e-4);
      if (testing::Test::HasFailure()) FAIL() << c.name;
    }
    EXPECT_GT(share / 10, 0.7) << c.name;
  }
}

TEST(LightDerivatives, Hit) {
  for (const LightCase& c : allCases()) {
    const RayTracer tracer(c.shapes);
    Random random(1, 2, 5);
    double share = 0;
    int count = 0;
    for (int k = 0; k < 20000 && count < 10; ++k) {
      const Vec3f o = randomPoint(random) * 2.0f, d = randomDirection(random);
      PrimitiveId id;
      if (c.isArea()) {
        id = tracer.intersect({o}, d);
        if (!id.valid() ||
            std::abs(dot(intersectPrimitive<float>(c.shapes, id, o, d).ng, d)) < 0.2f)
          continue;
      }
      ++count;
      const Frame<float> frame = Frame<float>::fromNormal(d);
      share += expectDerivatives<5>(
          [&]<class T>(const std::array<T, 5>& x) {
            const Vec3<T> origin = Vec3<T>(x[0], x[1], x[2]) + plain<T>(o);
            const Vec3<T> direction =
                ad::normalize(plain<T>(frame.s) * x[3] + plain<T>(frame.t) * x[4] + plain<T>(d));
            SurfacePoint<T> point{};
            if (id.valid()) point = intersectPrimitive<T>(c.shapes, id, origin, direction);
            return with(c, [&](const auto& l) {
              return outputs<T>(l.template hit<T>(c.context(), point, direction));
            });
          },
          {0, 0, 0, 0, 0}, 2e-4);
      if (testing::Test::HasFailure()) FAIL() << c.name;
    }
    EXPECT_GT(count, 5) << c.name;
    EXPECT_GT(share / count, 0.7) << c.name;
  }
}

template <class D>
double areaElement(const Vec3<D>& p, int i, int j) {
  const glm::dvec3 a(p.x.gradient(i), p.y.gradient(i), p.z.gradient(i)),
      b(p.x.gradient(j), p.y.gradient(j), p.z.gradient(j));
  return glm::length(glm::cross(a, b));
}

// The density of sampled directions is one over the solid angle that the coordinates' square
// becomes. (A mesh is chosen from by triangle: the density is that times the choice's probability.)
TEST(LightDerivatives, DirectDensityIsTheJacobian) {
  using D = ad::Dual2<double, 2>;
  for (const LightCase& c : allCases()) {
    if (with(c, [](const auto& l) { return l.isDelta(); })) continue;
    Random random(1, 2, 6);
    for (int k = 0; k < 200; ++k) {
      const float choice = random.uniform();
      const D u0 = D::variable(inner(random), 0), u1 = D::variable(inner(random), 1);
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const Vec3<D> reference = lift<D>(plain<D>(kReference));
        const auto r = l.template sampleDirect<D>(c.context(), id, reference, u0, u1);
        const double chosen =
            c.isArea() ? primitiveArea(c.shapes[0], id.primitive) / totalArea(c.shapes[0]) : 1;
        ASSERT_NEAR(areaElement(r.direction, 0, 1) * r.directPdf.v / chosen, 1, 1e-5) << c.name;
      });
    }
  }
}

TEST(LightDerivatives, EmissionDensityIsTheJacobian) {
  using D = ad::Dual2<double, 4>;
  for (const LightCase& c : allCases()) {
    Random random(1, 2, 7);
    for (int k = 0; k < 200; ++k) {
      const float choice = random.uniform();
      std::array<D, 4> u;
      for (int i = 0; i < 4; ++i) u[at(i)] = D::variable(inner(random), i);
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto r = l.template sampleEmission<D>(c.context(), id, u[0], u[1], u[2], u[3]);
        double volume = 1;
        if (l.isInfinite()) {
          // Where the disk is, depends on the direction; where on the disk, does not.
          volume *= areaElement(r.origin, 0, 1);
          if (!l.isDelta()) volume *= areaElement(r.direction, 2, 3);
        } else {
          if (!l.isDelta()) volume *= areaElement(r.origin, 0, 1);
          volume *= areaElement(r.direction, 2, 3);
        }
        const double chosen =
            c.isArea() ? primitiveArea(c.shapes[0], id.primitive) / totalArea(c.shapes[0]) : 1;
        ASSERT_NEAR(volume * r.emissionPdf.v / chosen, 1, 1e-5) << c.name;
      });
    }
  }
}

// Corners of the unit cube, where maps are singular, and seldom places: everything stays finite.
TEST(LightDerivatives, FiniteEverywhere) {
  using D = ad::Dual2<float, 4>;
  const float ends[] = {0, 1e-30f, 1e-12f, 1e-9f, 0x1p-24f, 1e-4f, 0.5f, 1 - 0x1p-24f};
  const Vec3f references[] = {kReference,
                              Vec3f(0),
                              Vec3f(1e6f, 0, 0),
                              Vec3f(-0.5f, 0.7f, 1.2f),
                              Vec3f(0.5f, 1.5f, -0.5f),
                              Vec3f(0.5f, 1.5f, 4)};
  for (const LightCase& c : allCases())
    for (const float a : ends)
      for (const float b : ends)
        with(c, [&](const auto& l) {
          const PrimitiveId id = l.choosePrimitive(c.context(), a);
          const D da = D::variable(a, 0), db = D::variable(b, 1);
          for (const Vec3f& reference : references) {
            const Vec3<D> from{D::variable(reference.x, 2), D::variable(reference.y, 3),
                               D(reference.z)};
            const auto r = l.template sampleDirect<D>(c.context(), id, from, da, db);
            for (const D& x : outputs<D>(r))
              ASSERT_TRUE(isFinite(x)) << c.name << " " << a << " " << b;
            ASSERT_GE(r.directPdf.v, 0);
          }
          for (const float e : ends)
            for (const float f : ends) {
              const auto r = l.template sampleEmission<D>(c.context(), id, da, db,
                                                          D::variable(e, 2), D::variable(f, 3));
              for (const D& x : outputs<D>(r))
                ASSERT_TRUE(isFinite(x)) << c.name << " " << a << " " << b << " " << e << " " << f;
              ASSERT_GT(r.emissionPdf.v, 0);
            }
          if (l.isEnvironment()) {
            // The poles and the seam, as the light's own axes have them.
            for (const Vec3f& axis :
                 {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(0, 0, -1), Vec3f(1, 0, 0), tilt()[1],
                  -tilt()[1], tilt()[2], -tilt()[2]}) {
              const Vec3<D> direction{D::variable(axis.x, 0), D::variable(axis.y, 1),
                                      D::variable(axis.z, 2)};
              const auto h = l.template hit<D>(c.context(), SurfacePoint<D>{}, direction);
              for (const D& x : outputs<D>(h)) ASSERT_TRUE(isFinite(x)) << c.name;
              if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, SunLight>)
                if (!l.disc().covers(axis)) continue;
              ASSERT_GT(h.directPdf.v, 0);
            }
          }
        });
}

}  // namespace
}  // namespace h2mc
