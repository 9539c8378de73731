// SPDX-License-Identifier: MIT
// Lights: conventions, inverses, and the same densities from each of their three functions.
#include <gtest/gtest.h>

#include "light_cases.h"
#include "render/geometry/ray_tracer.h"
#include "render/light/light_picker.h"

namespace h2mc {
namespace {

using namespace test;

const Vec3f kReference(0.2f, -0.4f, 0.3f);

void expectNear(const Vec3f& a, const Vec3f& b, float tolerance, const std::string& what) {
  EXPECT_LE(glm::length(a - b), tolerance) << what << ": " << a.x << " " << a.y << " " << a.z
                                           << " and " << b.x << " " << b.y << " " << b.z;
}
void expectSame(float a, float b, const std::string& what, float tolerance = 1e-4f) {
  EXPECT_NEAR(a, b, tolerance * std::abs(a)) << what;
}

// What hit() says of the ray's other end.
LightHit<float> hitOf(const LightCase& c, PrimitiveId id, const Vec3f& from, const Vec3f& along) {
  SurfacePoint<float> point{};
  if (c.isArea()) point = intersectPrimitive<float>(c.shapes, id, from, along);
  return with(c, [&](const auto& l) { return l.template hit<float>(c.context(), point, along); });
}

TEST(Lights, HitAgreesWithSampleDirect) {
  for (const LightCase& c : allCases()) {
    if (with(c, [](const auto& l) { return l.isDelta(); })) continue;
    Random random(3, 2, 1);
    for (int i = 0; i < 2000; ++i) {
      const float choice = random.uniform(), u0 = random.uniform(), u1 = random.uniform();
      with(c, [&](const auto& l) {
        PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto r = l.template sampleDirect<float>(c.context(), id, kReference, u0, u1);
        if (r.cosLight < 0.05f) return;
        if (c.isArea()) {
          const Shape& shape = c.shapes[0];
          // The root that the sample is; the triangle of the parallelogram.
          if (std::holds_alternative<Sphere>(shape.geometry)) {
            const auto near = intersectPrimitive<float>(c.shapes, {0, 0}, kReference, r.direction);
            id.primitive = glm::distance(near.p, r.position) > 1e-3f;
          }
          const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
          if (mesh && mesh->parallelogram) id.primitive = u0 < u1;
          expectNear(r.position, kReference + r.direction * r.distance, 1e-5f, c.name);
        }
        const LightHit<float> h = hitOf(c, id, kReference, r.direction);
        const float spread = c.isArea() ? r.distance * r.distance / r.cosLight : 1;
        expectSame(r.directPdf, h.directPdf * spread, c.name, 1e-3f);
        EXPECT_NEAR(r.emissionPdf, h.emissionPdf, 1e-3f * std::abs(h.emissionPdf) + 1e-6f)
            << c.name;
        const bool edgeOfField = c.name == "textured";
        if (!edgeOfField)
          expectNear(r.arriving * r.directPdf, h.radiance, 2e-3f * (glm::length(h.radiance) + 0.1f),
                     c.name);
      });
    }
  }
}

TEST(Lights, EmittedRaysAgreeWithDirectSamples) {
  for (const LightCase& c : allCases()) {
    Random random(3, 2, 2);
    for (int i = 0; i < 2000; ++i) {
      const float choice = random.uniform();
      const float u0 = random.uniform(), u1 = random.uniform(), v0 = random.uniform(),
                  v1 = random.uniform();
      with(c, [&](const auto& l) {
        const PrimitiveId id = l.choosePrimitive(c.context(), choice);
        const auto e = l.template sampleEmission<float>(c.context(), id, u0, u1, v0, v1);
        EXPECT_NEAR(glm::length(e.direction), 1, 1e-5f);
        if (e.cosLight < 0.05f) return;
        // Seen from a point on the ray, through the inverse.
        const float distance = l.isInfinite() ? 2 * c.bounds.radius : 1.7f;
        const Vec3f seenFrom = e.origin + e.direction * distance;
        Vec2f u;
        float back = 0.5f;
        ASSERT_TRUE(l.invertDirect(c.context(), id, seenFrom, -e.direction, distance, u, back))
            << c.name;
        const auto d = l.template sampleDirect<float>(c.context(), id, seenFrom, u.x, u.y);
        expectNear(d.direction, -e.direction, 1e-3f, c.name);
        const float tolerance = c.name.find("envmap") == std::string::npos ? 2e-3f : 2e-2f;
        expectSame(e.emissionPdf, d.emissionPdf, c.name, tolerance);
        if (c.name != "textured")
          expectNear(e.flux * e.emissionPdf, d.arriving * d.directPdf * d.cosLight,
                     tolerance * (glm::length(e.flux * e.emissionPdf) + 0.1f), c.name);
        if (c.isArea())
          expectSame(e.directPdf, d.directPdf * d.cosLight / (d.distance * d.distance), c.name,
                     2e-3f);
        else if (!l.isDelta())
          expectSame(e.directPdf, d.directPdf, c.name, tolerance);
        else
          EXPECT_EQ(e.directPdf, 1);
        if (l.isInfinite()) {
          EXPECT_GT(d.distance, 2 * c.bounds.radius);
        }
      });
    }
  }
}

// Coordinates that are angles may come back from across 0.
float apart(float a, float b, bool wraps) {
  const float d = std::abs(a - b);
  return wraps ? std::min(d, 1 - d) : d;
}

TEST(Lights, InvertGivesTheSampleBack) {
  for (const LightCase& c : allCases()) {
    Random random(3, 2, 3);
    for (int i = 0; i < 2000; ++i) {
      const float choice = random.uniform();
      const auto coordinate = [&] { return 0.02f + 0.96f * random.uniform(); };
      const float u0 = coordinate(), u1 = coordinate(), v0 = coordinate(), v1 = coordinate();
      with(c, [&](const auto& l) {
        const LightContext context = c.context();
        const PrimitiveId id = l.choosePrimitive(context, choice);
        const auto d = l.template sampleDirect<float>(context, id, kReference, u0, u1);
        Vec2f u, v;
        const float remainder = random.uniform();
        float back = remainder;
        ASSERT_TRUE(l.invertDirect(context, id, kReference, d.direction, d.distance, u, back))
            << c.name;
        EXPECT_EQ(l.choosePrimitive(context, back), id) << c.name;
        const auto again = l.template sampleDirect<float>(context, id, kReference, u.x, u.y);
        // Where the picture is dark, neighbouring floats are far apart as directions.
        const bool dark = c.name.find("envmap") != std::string::npos;
        const float tolerance = dark ? 5e-3f : 1e-4f;
        expectNear(again.direction, d.direction, dark ? 1e-3f : 1e-5f, c.name);
        if (!l.isDelta()) {
          EXPECT_LT(apart(u.x, u0, l.wrapsDirect(context) & 1), tolerance) << c.name;
          EXPECT_LT(apart(u.y, u1, l.wrapsDirect(context) & 2), tolerance) << c.name;
        }

        const auto e = l.template sampleEmission<float>(context, id, u0, u1, v0, v1);
        back = remainder;
        ASSERT_TRUE(l.invertEmission(context, id, e.origin, e.direction, u, v, back)) << c.name;
        EXPECT_EQ(l.choosePrimitive(context, back), id) << c.name;
        const auto same = l.template sampleEmission<float>(context, id, u.x, u.y, v.x, v.y);
        expectNear(same.origin, e.origin, tolerance, c.name);
        expectNear(same.direction, e.direction, dark ? 1e-3f : 1e-4f, c.name);
      });
    }
  }
}

// 0 and 1 are the same for coordinates that wrap, and not for the others.
TEST(Lights, WrapsWhatTheyTellToWrap) {
  const float end = 1 - 0x1p-24f;
  for (const LightCase& c : allCases())
    with(c, [&](const auto& l) {
      const LightContext context = c.context();
      const PrimitiveId id = l.choosePrimitive(context, 0.3f);
      const unsigned direct = l.wrapsDirect(context), emission = l.wrapsEmission(context);
      // The last float before 1 is farther from 1 where the picture is dark.
      const float tolerance = c.name == "envmap" ? 1e-2f : 1e-4f;
      for (int i = 0; i < 4; ++i) {
        float low[4] = {0.31f, 0.43f, 0.27f, 0.64f}, high[4] = {0.31f, 0.43f, 0.27f, 0.64f};
        low[i] = 0;
        high[i] = end;
        const auto a =
            l.template sampleEmission<float>(context, id, low[0], low[1], low[2], low[3]);
        const auto b =
            l.template sampleEmission<float>(context, id, high[0], high[1], high[2], high[3]);
        const float moved =
            glm::distance(a.origin, b.origin) + glm::distance(a.direction, b.direction);
        if (emission >> i & 1) {
          EXPECT_LT(moved, tolerance) << c.name << " " << i;
        }
        if (i >= 2) continue;
        const auto p = l.template sampleDirect<float>(context, id, kReference, low[0], low[1]);
        const auto q = l.template sampleDirect<float>(context, id, kReference, high[0], high[1]);
        const float turned = glm::distance(p.direction, q.direction);
        if (direct >> i & 1) {
          EXPECT_LT(turned, tolerance) << c.name << " " << i;
        } else if (!l.isDelta()) {
          EXPECT_GT(turned, 1e-2f) << c.name << " " << i;
        }
      }
    });
}

TEST(Lights, AreaLightsEmitOnTheirNormalsSide) {
  const LightCase c =
      areaCase("square", parallelogram(Vec3f(-1, -1, 0), Vec3f(2, 0, 0), Vec3f(0, 2, 0)));
  const auto& l = std::get<AreaLight>(c.light);
  const auto front = l.sampleDirect<float>(c.context(), {0, 0}, Vec3f(0, 0, 2), 0.5f, 0.5f);
  EXPECT_EQ(front.arriving, Rgbf(1, 2, 3));
  EXPECT_FLOAT_EQ(front.directPdf, 1);  // 2^2 / (1 * 4)
  EXPECT_FLOAT_EQ(front.distance, 2);
  EXPECT_FLOAT_EQ(front.emissionPdf, kInvPi / 4);
  EXPECT_EQ(front.position, Vec3f(0));
  EXPECT_EQ(front.normal, Vec3f(0, 0, 1));
  const auto back = l.sampleDirect<float>(c.context(), {0, 0}, Vec3f(0, 0, -2), 0.5f, 0.5f);
  EXPECT_EQ(back.arriving, Rgbf(0));
  EXPECT_EQ(back.emissionPdf, 0);
  EXPECT_FLOAT_EQ(back.directPdf, 1);
  const auto at = l.sampleDirect<float>(c.context(), {0, 0}, Vec3f(0), 0.5f, 0.5f);
  EXPECT_EQ(at.directPdf, 0);
  EXPECT_EQ(at.arriving, Rgbf(0));
  SurfacePoint<float> p = samplePrimitive<float>(c.shapes, {0, 0}, 0.5f, 0.5f);
  EXPECT_EQ(l.hit<float>(c.context(), p, Vec3f(0, 0, -1)).radiance, Rgbf(1, 2, 3));
  EXPECT_EQ(l.hit<float>(c.context(), p, Vec3f(0, 0, 1)).radiance, Rgbf(0));
  EXPECT_FLOAT_EQ(l.power(c.bounds), kPi * 4 * luminance(Rgbf(1, 2, 3)));

  AreaLight unprepared;
  unprepared.radiance = constantTexture(Rgbf(1));
  EXPECT_THROW(unprepared.power(c.bounds), std::logic_error);
}

TEST(Lights, TextureFollowsTheSurface) {
  const LightCase c = areaCase(
      "square", parallelogram(Vec3f(-1, -1, 0), Vec3f(2, 0, 0), Vec3f(0, 2, 0)), checkers());
  const auto& l = std::get<AreaLight>(c.light);
  for (const float u0 : {0.1f, 0.35f, 0.8f})
    for (const float u1 : {0.2f, 0.45f, 0.7f}) {
      const auto p = samplePrimitive<float>(c.shapes, {0, 0}, u0, u1);
      const Rgbf expected = evaluate<float>(*l.radiance, p.uv);
      const auto d = l.sampleDirect<float>(c.context(), {0, 0}, Vec3f(0, 0, 2), u0, u1);
      expectNear(d.arriving * d.directPdf, expected, 1e-6f, "direct");
      const auto e = l.sampleEmission<float>(c.context(), {0, 0}, u0, u1, 0.3f, 0.2f);
      expectNear(e.flux * e.emissionPdf, expected * e.cosLight, 1e-6f, "emitted");
    }
}

TEST(Lights, SpotFallsOffLinearlyInTheAngle) {
  const SpotLight l(Vec3f(0), Vec3f(0, 0, 1), Rgbf(2), 40, 20);
  const LightContext context{};
  const auto intensityAt = [&](float degrees) {
    const float a = glm::radians(degrees);
    const Vec3f point = Vec3f(std::sin(a), 0, std::cos(a)) * 3.0f;
    const auto d = l.sampleDirect<float>(context, {}, point, 0.5f, 0.5f);
    return d.arriving.x * d.directPdf;
  };
  EXPECT_FLOAT_EQ(intensityAt(0), 2);
  EXPECT_FLOAT_EQ(intensityAt(19), 2);
  EXPECT_NEAR(intensityAt(25), 1.5f, 1e-4f);
  EXPECT_NEAR(intensityAt(30), 1, 1e-4f);
  EXPECT_NEAR(intensityAt(39), 0.1f, 1e-4f);
  EXPECT_EQ(intensityAt(41), 0);
  EXPECT_EQ(intensityAt(170), 0);
}

// Up is +y, the middle of the picture is +z, u grows from -z by way of +x.
TEST(Lights, EnvmapOrientation) {
  Image image(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x)
      image.at(x, y) = Rgbf(static_cast<float>(x), static_cast<float>(y), 1);
  const EnvmapLight l(image, 2, glm::mat3(1));
  const LightContext context{};
  const auto at = [&](const Vec3f& d) {
    return l.hit<float>(context, SurfacePoint<float>{}, glm::normalize(d)).radiance;
  };
  expectNear(at(Vec3f(1, 0, 0)), Rgbf(1.5f, 1.5f, 1) * 2.0f, 1e-4f, "+x: u = 1/4");
  expectNear(at(Vec3f(0, 0, 1)), Rgbf(3.5f, 1.5f, 1) * 2.0f, 1e-4f, "+z: u = 1/2");
  expectNear(at(Vec3f(-1, 0, 0)), Rgbf(5.5f, 1.5f, 1) * 2.0f, 1e-4f, "-x: u = 3/4");
  expectNear(at(Vec3f(1e-6f, 0, -1)), Rgbf(3.5f, 1.5f, 1) * 2.0f, 1e-3f, "-z: the seam");
  EXPECT_NEAR(at(Vec3f(0, 1, 0)).y, 0, 1e-5f);
  EXPECT_NEAR(at(Vec3f(0, -1, 0)).y, 6, 1e-5f);
  // Elevation 3/8 of pi from the top is the centre of the second row.
  const float theta = 3 * kPi / 8;
  EXPECT_NEAR(at(Vec3f(std::sin(theta), std::cos(theta), 0)).y, 2, 1e-4f);

  // A rotation by 90 degrees about y takes +z to +x.
  const EnvmapLight turned(image, 2, glm::mat3(0, 0, -1, 0, 1, 0, 1, 0, 0));
  expectNear(turned.hit<float>(context, SurfacePoint<float>{}, Vec3f(1, 0, 0)).radiance,
             Rgbf(3.5f, 1.5f, 1) * 2.0f, 1e-4f, "turned");
}

TEST(Lights, BlackEnvmapIsStillADensity) {
  const Image black(4, 2);
  const EnvmapLight l(black, 1, glm::mat3(1));
  const LightContext context{};
  EXPECT_EQ(l.power(SceneBounds{}), 0);
  EXPECT_GT(l.sampleDirect<float>(context, {}, Vec3f(0), 0.3f, 0.6f).directPdf, 0);
}

TEST(LightPicker, ChoosesByPower) {
  const LightPicker none;
  EXPECT_EQ(none.choose(0.5f).light, -1);
  const LightPicker picker({0, 1, 0, 3, 0});
  EXPECT_EQ(picker.choose(0).light, 1);
  EXPECT_EQ(picker.choose(0.2499f).light, 1);
  EXPECT_EQ(picker.choose(0.25f).light, 3);
  EXPECT_FLOAT_EQ(picker.choose(0.25f).remainder, 0);
  EXPECT_FLOAT_EQ(picker.choose(0.625f).remainder, 0.5f);
  EXPECT_EQ(picker.choose(1 - 0x1p-24f).light, 3);
  EXPECT_LT(picker.choose(1 - 0x1p-24f).remainder, 1);
  EXPECT_FLOAT_EQ(picker.probability(1), 0.25f);
  EXPECT_FLOAT_EQ(picker.probability(3), 0.75f);
  EXPECT_EQ(picker.probability(2), 0);
  for (const int light : {1, 3})
    for (const float r : {0.f, 0.3f, 0.999999f}) {
      const auto c = picker.choose(picker.invert(light, r));
      EXPECT_EQ(c.light, light);
      EXPECT_NEAR(c.remainder, r, 1e-6f);
    }
  const LightPicker dark({0, 0});
  EXPECT_EQ(dark.choose(0.7f).light, 1);
  EXPECT_FLOAT_EQ(dark.probability(0), 0.5f);
}

}  // namespace
}  // namespace h2mc
