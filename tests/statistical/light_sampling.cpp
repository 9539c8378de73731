// SPDX-License-Identifier: MIT
// What lights sample, against the densities they tell and the light they emit.
#include <gtest/gtest.h>

#include "chi_square.h"
#include "light_cases.h"
#include "render/core/index.h"
#include "render/geometry/ray_tracer.h"

namespace h2mc {
namespace {

using namespace test;

const Vec3f kReference(0.2f, -0.4f, 0.3f);

// Calls f(hit, surface point) for everything of the light along a ray: every crossing of an area
// light's surface, the environment.
template <class F>
void alongRay(const LightCase& c, const RayTracer& tracer, const Vec3f& from,
              const Vec3f& direction, F&& f) {
  with(c, [&](const auto& l) {
    if (!c.isArea()) {
      f(l.template hit<float>(c.context(), SurfacePoint<float>{}, direction),
        SurfacePoint<float>{});
      return;
    }
    Vec3f origin = from, normal(0);
    for (int i = 0; i < 10; ++i) {
      const PrimitiveId id = tracer.intersect({origin, normal}, direction);
      if (!id.valid()) return;
      const auto p = intersectPrimitive<float>(c.shapes, id, origin, direction);
      f(l.template hit<float>(c.context(), p, direction), p);
      origin = p.p;
      normal = p.ng;
    }
  });
}

// Near a sphere's outline the density has a pole, too steep to integrate: samples that leave their
// light flatter than this are counted together.
constexpr float kFlat = 0.1f;

// The density of directions at kReference, but for flat ones.
double directionPdf(const LightCase& c, const RayTracer& tracer, const Vec3f& direction) {
  double pdf = 0;
  alongRay(c, tracer, kReference, direction,
           [&](const LightHit<float>& h, const SurfacePoint<float>& p) {
             if (!c.isArea()) {
               pdf = static_cast<double>(h.directPdf);
               return;
             }
             const Vec3f d = p.p - kReference;
             const float cosine = std::abs(dot(p.ng, direction));
             if (cosine > kFlat) pdf += static_cast<double>(h.directPdf * dot(d, d) / cosine);
           });
  return pdf;
}

// The share of flat samples, by the surface's area and not by the light's sampling.
double flatShare(const LightCase& c) {
  if (!c.isArea()) return 0;
  double flat = 0;
  const auto* mesh = std::get_if<TriangleMesh>(&c.shapes[0].geometry);
  const auto count = mesh && !mesh->parallelogram ? mesh->triangles.size() : 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    constexpr int kGrid = 300;
    int n = 0;
    for (int k = 0; k < kGrid * kGrid; ++k) {
      const auto p = samplePrimitive<float>(c.shapes, {0, i}, (k / kGrid + 0.5f) / kGrid,
                                            (k % kGrid + 0.5f) / kGrid);
      n += std::abs(dot(p.ng, glm::normalize(p.p - kReference))) <= kFlat;
    }
    flat += n * primitiveArea(c.shapes[0], i) / (kGrid * kGrid);
  }
  return flat / totalArea(c.shapes[0]);
}

std::vector<LightCase> hittable() {
  std::vector<LightCase> cases = areaCases();
  for (auto& c : infiniteCases()) cases.push_back(c);
  return cases;
}

TEST(LightSampling, SlowDirectionsFollowTheDensity) {
  constexpr int kRings = 12, kSectors = 24, kFine = 64;
  constexpr int kSamples = 40000;
  const std::vector<LightCase> cases = hittable();
  for (const LightCase& c : cases) {
    const RayTracer tracer(c.shapes);
    std::vector<double> observed(kRings * kSectors + 1), expected(kRings * kSectors);
    double integral = 0;
    for (int i = 0; i < kRings * kFine; ++i)
      for (int j = 0; j < kSectors * kFine; ++j) {
        const double z = 1 - 2 * (i + 0.5) / (kRings * kFine), rho = std::sqrt(1 - z * z);
        const double phi = 2 * M_PI * (j + 0.5) / (kSectors * kFine);
        const double mass =
            directionPdf(c, tracer,
                         Vec3f(glm::dvec3(rho * std::cos(phi), rho * std::sin(phi), z))) *
            4 * M_PI / (kRings * kSectors * kFine * kFine);
        expected[at(i / kFine * kSectors + j / kFine)] += mass * kSamples;
        integral += mass;
      }
    // How many samples are flat is not told by the integral alone: a direct count is.
    const double flat = flatShare(c);
    EXPECT_NEAR(integral + flat, 1, 5e-3) << c.name;
    for (double& e : expected) e *= (1 - flat) / integral;
    expected.push_back(flat * kSamples);

    Random random(7, 7, 7);
    for (int i = 0; i < kSamples; ++i) {
      const float choice = random.uniform(), u0 = random.uniform(), u1 = random.uniform();
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto r = l.template sampleDirect<float>(c.context(), id, kReference, u0, u1);
        const Vec3f d = r.direction;
        if (r.cosLight <= kFlat) {
          ++observed.back();
          return;
        }
        const int ring = std::clamp(static_cast<int>((1 - d.z) / 2 * kRings), 0, kRings - 1);
        const double turn =
            std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)) / (2 * M_PI);
        const int sector =
            std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kSectors), 0, kSectors - 1);
        ++observed[at(ring * kSectors + sector)];
      });
    }
    const auto verdict = chiSquareTest(observed, expected, static_cast<int>(cases.size()));
    EXPECT_TRUE(verdict.passed) << c.name << ": " << verdict.message;
  }
}

// Emitted directions: around the normal of area lights by the cosine, elsewhere as direct samples.
TEST(LightSampling, EmittedDirectionsFollowTheirDensity) {
  constexpr int kCells = 16, kSamples = 40000;
  const std::vector<LightCase> cases = areaCases();
  for (const LightCase& c : cases) {
    std::vector<double> observed(kCells * kCells),
        expected(kCells * kCells, double(kSamples) / (kCells * kCells));
    Random random(7, 7, 8);
    for (int i = 0; i < kSamples; ++i) {
      const float choice = random.uniform();
      const float u0 = random.uniform(), u1 = random.uniform(), v0 = random.uniform(),
                  v1 = random.uniform();
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto e = l.template sampleEmission<float>(c.context(), id, u0, u1, v0, v1);
        const Vec3f local = Frame<float>::fromNormal(e.normal).toLocal(e.direction);
        EXPECT_NEAR(local.z, e.cosLight, 1e-4f);
        // Equal shares of the projected disk.
        const double r2 = static_cast<double>(local.x * local.x + local.y * local.y);
        const double turn =
            std::atan2(static_cast<double>(local.y), static_cast<double>(local.x)) / (2 * M_PI) +
            0.5;
        const int ring = std::min(static_cast<int>(r2 * kCells), kCells - 1);
        const int sector = std::min(static_cast<int>(turn * kCells), kCells - 1);
        ++observed[at(ring * kCells + sector)];
      });
    }
    const auto verdict = chiSquareTest(observed, expected, static_cast<int>(cases.size()));
    EXPECT_TRUE(verdict.passed) << c.name << ": " << verdict.message;
  }
}

struct Mean {
  double sum = 0, squares = 0;
  int n = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++n;
  }
  double mean() const { return sum / n; }
  double error() const { return std::sqrt(std::max(squares / n - mean() * mean(), 0.0) / n); }
};

// The flux of the emitted rays is the light's power; exactly so for all but textured lights.
TEST(LightSampling, PowerIsTheFluxOfTheRays) {
  for (const LightCase& c : allCases()) {
    Random random(7, 7, 9);
    Mean flux;
    for (int i = 0; i < 100000; ++i) {
      const float choice = random.uniform();
      const float u0 = random.uniform(), u1 = random.uniform(), v0 = random.uniform(),
                  v1 = random.uniform();
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto e = l.template sampleEmission<float>(c.context(), id, u0, u1, v0, v1);
        flux.add(static_cast<double>(luminance(e.flux)));
      });
    }
    const double power =
        static_cast<double>(with(c, [&](const auto& l) { return l.power(c.bounds); }));
    // power() of textured lights is an estimate, and sums the pixels of pictures without the
    // bilinear blending.
    const bool estimate =
        c.name.find("textur") != std::string::npos || c.name.find("envmap") != std::string::npos;
    EXPECT_NEAR(flux.mean() / power, 1, 4.5 * flux.error() / power + (estimate ? 0.25 : 1e-4))
        << c.name;
  }
}

// Light that arrives on a surface: by samples of the light, and by looking in all directions.
TEST(LightSampling, IrradianceBothWays) {
  for (const LightCase& c : hittable()) {
    const RayTracer tracer(c.shapes);
    const Vec3f normal = glm::normalize(Vec3f(-0.2f, 0.5f, 0.6f));
    const Frame<float> frame = Frame<float>::fromNormal(normal);
    Random random(7, 7, 10);
    Mean sampled, looked;
    for (int i = 0; i < 200000; ++i) {
      const float choice = random.uniform(), u0 = random.uniform(), u1 = random.uniform();
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto r = l.template sampleDirect<float>(c.context(), id, kReference, u0, u1);
        const float cosine = std::max(dot(r.direction, normal), 0.0f);
        sampled.add(static_cast<double>(luminance(r.arriving) * cosine));
      });
      const float v0 = random.uniform(), v1 = random.uniform();
      const Vec2f d = detail::uniformDisk(v0, v1);
      double radiance = 0;
      alongRay(c, tracer, kReference, frame.toWorld(Vec3f(d.x, d.y, std::sqrt(1 - v0))),
               [&](const LightHit<float>& h, const SurfacePoint<float>&) {
                 radiance += static_cast<double>(luminance(h.radiance));
               });
      looked.add(radiance * M_PI);
    }
    const double error = std::hypot(sampled.error(), looked.error());
    EXPECT_NEAR(sampled.mean(), looked.mean(), 4.5 * error) << c.name;
    EXPECT_LT(error, 0.1 * looked.mean() + 1e-9) << c.name;
    // Sampling by radiance: little is left of the picture's range of brightness.
    if (!c.isArea()) {
      EXPECT_LT(sampled.error() * std::sqrt(200000.0), 3 * sampled.mean()) << c.name;
    }
  }
}

// Mesh lights: triangles by area.
TEST(LightSampling, TrianglesByArea) {
  const LightCase c = areaCase("ball", moved(ball(4, false), tilt(), 1, Vec3f(0)));
  const auto& mesh = std::get<TriangleMesh>(c.shapes[0].geometry);
  std::vector<double> observed(mesh.triangles.size()), expected(mesh.triangles.size());
  constexpr int kSamples = 50000;
  Random random(7, 7, 11);
  for (int i = 0; i < kSamples; ++i)
    ++observed
        [std::get<AreaLight>(c.light).choosePrimitive(c.context(), random.uniform()).primitive];
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[i] = kSamples * primitiveArea(c.shapes[0], static_cast<std::uint32_t>(i)) /
                  totalArea(c.shapes[0]);
  const auto verdict = chiSquareTest(observed, expected, 1);
  EXPECT_TRUE(verdict.passed) << verdict.message;
}

}  // namespace
}  // namespace h2mc
