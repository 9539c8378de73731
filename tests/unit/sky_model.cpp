// SPDX-License-Identifier: MIT
#include "render/light/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/light/light.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

// A scene with these lights alone.
std::string sceneWith(const std::string& lights) {
  return "<scene version=\"0.6.0\">" + lights + "<shape type=\"rectangle\"/>" + testing::kCamera +
         "</scene>";
}

constexpr double kPiD = std::numbers::pi;

// Irradiance over pi on a horizontal surface.
glm::dvec3 irradiance(const SkyModel& sky) {
  constexpr int kRings = 200, kSectors = 400;
  glm::dvec3 sum(0);
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSectors; ++j) {
      // Uniform in sin^2: weighted by the cosine.
      const double sine = std::sqrt((i + 0.5) / kRings), phi = 2 * kPiD * (j + 0.5) / kSectors;
      sum += glm::dvec3(
          sky.radiance({std::sin(phi) * sine, std::sqrt(1 - sine * sine), -std::cos(phi) * sine}));
    }
  return sum / double(kRings * kSectors);
}

struct Measured {
  double turbidity;
  glm::dvec3 sun;           // direction
  glm::dvec3 ofSun, ofSky;  // irradiance over pi
};

// As an independent renderer has it, from the pictures that it makes of sun and sky; three digits.
const Measured kMeasured[] = {{2, {0, 1, 0}, {0.503, 0.436, 0.390}, {0.0430, 0.0775, 0.1348}},
                              {2, {1, 1, 0}, {0.331, 0.280, 0.237}, {0.0372, 0.0651, 0.1193}},
                              {2, {3, 1, 0}, {0.110, 0.0835, 0.0557}, {0.0300, 0.0499, 0.0766}},
                              {3, {0, 1, 0}, {0.464, 0.394, 0.342}, {0.0592, 0.0868, 0.1389}},
                              {3, {1, 1, 0}, {0.295, 0.243, 0.196}, {0.0484, 0.0752, 0.1262}},
                              {3, {3, 1, 0}, {0.0847, 0.0606, 0.0366}, {0.0373, 0.0556, 0.0788}},
                              {6, {0, 1, 0}, {0.363, 0.290, 0.229}, {0.1085, 0.1341, 0.1598}},
                              {6, {1, 1, 0}, {0.209, 0.157, 0.111}, {0.0964, 0.1186, 0.1557}},
                              {6, {3, 1, 0}, {0.0390, 0.0231, 0.0103}, {0.0667, 0.0762, 0.0858}}};

TEST(SkyModel, HasTheMeasuredIrradiance) {
  for (const Measured& m : kMeasured) {
    const glm::dvec3 found = irradiance(SkyModel(m.turbidity, Rgbf(0.2f), glm::normalize(m.sun)));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c] / m.ofSky[c], 1, 0.01) << m.turbidity << " " << m.sun.x << " " << c;
  }
}

TEST(SkyModel, TheSunHasTheMeasuredIrradiance) {
  for (const Measured& m : kMeasured) {
    const double cosine = glm::normalize(m.sun).y;
    const glm::dvec3 found = glm::dvec3(sunRadiance(std::acos(cosine), m.turbidity)) * cosine *
                             (2 * (1 - std::cos(kSunRadius)));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c] / m.ofSun[c], 1, 0.01) << m.turbidity << " " << m.sun.x << " " << c;
  }
}

// A wrong digit among the coefficients would show as a jump.
TEST(SkyModel, IsSmoothInTurbidityElevationAndAlbedo) {
  const auto at = [](double turbidity, double elevation, float albedo) {
    const SkyModel sky(turbidity, Rgbf(albedo), {std::cos(elevation), std::sin(elevation), 0});
    glm::dvec3 mean(0);
    for (const glm::dvec3& d :
         {glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0.8, 0), glm::dvec3(-0.6, 0.8, 0),
          glm::dvec3(0, 0.3, 0.954), glm::dvec3(-0.98, 0.2, 0)})
      mean += glm::dvec3(sky.radiance(d));
    return mean;
  };
  for (int turbidity = 1; turbidity <= 9; ++turbidity)
    for (int step = 1; step < 20; ++step) {
      const double elevation = step * kPiD / 40;
      for (const float albedo : {0.f, 1.f}) {
        const glm::dvec3 a = at(turbidity, elevation, albedo),
                         b = at(turbidity + 1, elevation, albedo),
                         middle = at(turbidity + 0.5, elevation, albedo);
        for (int c = 0; c < 3; ++c) {
          EXPECT_GT(a[c], 0);
          EXPECT_LT(std::abs(std::log(b[c] / a[c])), 1.2) << turbidity << " " << elevation;
          EXPECT_NEAR(middle[c] / ((a[c] + b[c]) / 2), 1, 0.35) << turbidity << " " << elevation;
        }
      }
    }
}

// Almanac: on 20 March 2015 the sun crossed the equator; at noon it stands as high as the place is far from the pole.
TEST(SkyModel, FindsTheSun) {
  const auto zenith = [](const PlaceAndTime& when) {
    return std::acos(sunDirectionAt(when).y) * 180 / kPiD;
  };
  // Greenwich; the equation of time is -7.5 minutes.
  const PlaceAndTime noon{51.48, 0, 0, 2015, 3, 20, 12, 7.5, 0};
  EXPECT_NEAR(zenith(noon), 51.48, 0.3);
  EXPECT_LT(std::abs(sunDirectionAt(noon).x), 0.01);
  EXPECT_GT(sunDirectionAt(noon).z, 0) << "south";
  PlaceAndTime morning = noon;
  morning.hour = 8;
  EXPECT_GT(sunDirectionAt(morning).x, 0.5) << "east";
  // Its highest in Sydney's summer, some 10.4 degrees from the zenith; clocks are 10 hours ahead.
  EXPECT_NEAR(zenith({-33.87, 151.21, 10, 2014, 12, 22, 11, 54, 0}), 33.87 - 23.44, 0.3);
}

// Light from a direction: of one light alone, and all that there is.
Rgbf fromSky(const Scene& scene, const Vec3f& direction) {
  const int light = scene.environmentAt(direction);
  if (light < 0) return Rgbf(0);
  return std::visit(
      [&](const auto& l) {
        return l.template hit<float>(scene.lightContext(), SurfacePoint<float>{}, direction)
            .radiance;
      },
      scene.lights[static_cast<std::size_t>(light)]);
}

std::string sky(const std::string& type, const std::string& more) {
  return "<emitter type=\"" + type + "\"><vector name=\"sunDirection\" x=\"0.6\" y=\"0.8\"/>" +
         "<float name=\"sunRadiusScale\" value=\"10\"/>" + more + "</emitter>";
}

TEST(SkyLights, SunskyIsTheSumOfBoth) {
  const SceneFolder folder;
  const std::string onlySky =
      "<emitter type=\"sky\"><vector name=\"sunDirection\" x=\"0.6\" y=\"0.8\"/></emitter>";
  const Scene both = folder.read(sceneWith(sky("sunsky", "")));
  const Scene sunAlone = folder.read(sceneWith(sky("sun", "")));
  const Scene skyAlone = folder.read(sceneWith(onlySky));
  const Scene apart = folder.read(sceneWith(onlySky + sky("sun", "")));
  EXPECT_EQ(both.lights.size(), 2u);
  for (const Vec3f& d : {Vec3f(0.6f, 0.8f, 0), glm::normalize(Vec3f(0.62f, 0.8f, 0.01f)),
                         Vec3f(0, 1, 0), Vec3f(-0.6f, 0.8f, 0), Vec3f(0, -1, 0)}) {
    const Rgbf sum = fromSky(sunAlone, d) + fromSky(skyAlone, d);
    EXPECT_LT(glm::length(fromSky(both, d) - sum), 1e-5f * glm::length(sum) + 1e-9f);
    EXPECT_LT(glm::length(fromSky(apart, d) - sum), 1e-5f * glm::length(sum) + 1e-9f);
  }
  EXPECT_GT(luminance(fromSky(both, Vec3f(0.6f, 0.8f, 0))),
            5 * luminance(fromSky(skyAlone, Vec3f(0.6f, 0.8f, 0))));
  // What the environment would send from the sun's place is the sun's.
  const auto& map = both.lights[static_cast<std::size_t>(both.environment)];
  const auto direct = std::visit(
      [&](const auto& l) {
        for (float u = 0.005f; u < 1; u += 0.01f)
          for (float v = 0.005f; v < 1; v += 0.01f) {
            const auto r =
                sampleDirectAt<float>(l, both.lightContext(), {}, Vec3f(0), u, v, nullptr);
            const bool covered = both.suns[0].covers(r.direction);
            if (covered != !(luminance(r.arriving) > 0) && r.direction.y > 0.05f) return false;
          }
        return true;
      },
      map);
  EXPECT_TRUE(direct);
}

TEST(SkyLights, ScalesAndRadius) {
  const SceneFolder folder;
  const Vec3f sun(0.6f, 0.8f, 0), zenith(0, 1, 0);
  const auto number = [](const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
  };
  const Scene one = folder.read(sceneWith(sky("sunsky", "")));
  const Scene sunny = folder.read(sceneWith(sky("sunsky", number("sunScale", "3"))));
  const Scene bright = folder.read(sceneWith(sky("sunsky", number("scale", "2"))));
  EXPECT_NEAR(luminance(fromSky(sunny, zenith)) / luminance(fromSky(one, zenith)), 1, 1e-5);
  EXPECT_NEAR(luminance(fromSky(sunny, sun)) / luminance(fromSky(one, sun)), 3, 0.1);
  EXPECT_NEAR(luminance(fromSky(bright, zenith)) / luminance(fromSky(one, zenith)), 2, 1e-4);
  EXPECT_NEAR(luminance(fromSky(bright, sun)) / luminance(fromSky(one, sun)), 2, 1e-4);
  // All from one direction: as much light.
  const Scene narrow = folder.read(
      sceneWith("<emitter type=\"sun\"><vector name=\"sunDirection\" x=\"0.6\" y=\"0.8\"/>"
                "<float name=\"sunRadiusScale\" value=\"0\"/></emitter>"));
  const Scene wide = folder.read(sceneWith(sky("sun", "")));
  const auto power = [](const Scene& scene) {
    return std::visit([&](const auto& l) { return l.power(scene.bounds); }, scene.lights.at(0));
  };
  EXPECT_TRUE(std::holds_alternative<DirectionalLight>(narrow.lights[0]));
  EXPECT_NEAR(power(narrow) / power(wide), 1, 1e-4);
}

// Of version 3: z is up, south along x and west along y; the sun's diameter is in degrees; the ground is brighter.
TEST(SkyLights, SunskyOfVersion3) {
  const SceneFolder folder;
  const auto number = [](const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
  };
  const auto recent = [&](const std::string& inside) {
    return folder.read(
        testing::modern(sceneWith("<emitter type=\"sunsky\">" + inside + "</emitter>")));
  };
  const auto old = [&](const std::string& inside) {
    return folder.read(sceneWith("<emitter type=\"sunsky\">" + inside + "</emitter>"));
  };
  // To where the old frame has it: (x, y, z) is (-y, z, x) there.
  const auto turned = [](const Vec3f& d) { return Vec3f(-d.y, d.z, d.x); };
  const Scene a = recent("<vector name=\"sun_direction\" x=\"0.36\" y=\"-0.48\" z=\"0.8\"/>" +
                         number("sun_aperture", "5.358"));
  const Scene b =
      old("<vector name=\"sunDirection\" x=\"0.48\" y=\"0.8\" z=\"0.36\"/>"
          "<rgb name=\"albedo\" value=\"0.3\"/>" +
          number("sunRadiusScale", "10"));
  for (const Vec3f& d : {Vec3f(0.36f, -0.48f, 0.8f), Vec3f(0, 0, 1), Vec3f(0.6f, 0, 0.8f),
                         Vec3f(-0.6f, 0.64f, 0.48f), Vec3f(0, 0.6f, -0.8f)}) {
    const Rgbf here = fromSky(a, d), there = fromSky(b, turned(d));
    EXPECT_LT(glm::length(here - there), 2e-3f * glm::length(there) + 1e-9f);
  }
  EXPECT_GT(luminance(fromSky(a, Vec3f(0, 0, 1))), 0);
  EXPECT_EQ(fromSky(a, Vec3f(0, 0, -1)), Rgbf(0));
  // The other frame must not be taken for it.
  EXPECT_EQ(fromSky(a, Vec3f(0, -1, -0.1f)), Rgbf(0));
  // By place and time: in Tokyo, in the afternoon, the sun is in the south-west.
  const Scene dated = recent(number("hour", "15"));
  const Vec3f sun = dated.suns.at(0).direction;
  EXPECT_GT(sun.z, 0.5f);
  EXPECT_GT(sun.y, 0.3f);
  EXPECT_LT(glm::distance(turned(sun), old(number("hour", "15")).suns.at(0).direction), 1e-5f);
  // That the sun is another model's is said.
  ASSERT_EQ(dated.warnings.size(), 1u);
  EXPECT_NE(dated.warnings[0].find("Hosek and Wilkie 2013"), std::string::npos);
  EXPECT_TRUE(recent(number("sun_scale", "0")).warnings.empty());
  EXPECT_TRUE(old("").warnings.empty());
  EXPECT_NE(folder
                .error(testing::modern(sceneWith("<emitter type=\"sunsky\">" +
                                                 number("sun_aperture", "1") +
                                                 number("sun_radius_scale", "2") + "</emitter>")))
                .find("give either sunAperture or sunRadiusScale"),
            std::string::npos);
}

TEST(SkyLights, EnvironmentsAreAdded) {
  const SceneFolder folder;
  const std::string constant =
      "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.5, 0.25, 0.125\"/></emitter>";
  const std::string turned =
      "<emitter type=\"sky\"><vector name=\"sunDirection\" x=\"-0.6\" y=\"0.8\"/>"
      "<integer name=\"resolution\" value=\"256\"/></emitter>";
  const std::string plain =
      "<emitter type=\"sky\"><vector name=\"sunDirection\" x=\"0.6\" y=\"0.8\"/></emitter>";
  const Scene two = folder.read(sceneWith(constant + constant));
  EXPECT_EQ(two.lights.size(), 1u);
  EXPECT_EQ(fromSky(two, Vec3f(0, 1, 0)), Rgbf(1, 0.5f, 0.25f));
  const Scene a = folder.read(sceneWith(plain)), b = folder.read(sceneWith(turned)),
              all = folder.read(sceneWith(constant + turned + plain));
  for (const Vec3f& d : {Vec3f(0, 1, 0), Vec3f(0.6f, 0.8f, 0), Vec3f(-0.64f, 0.48f, 0.6f)}) {
    const Rgbf sum = fromSky(a, d) + fromSky(b, d) + Rgbf(0.5f, 0.25f, 0.125f);
    EXPECT_LT(glm::length(fromSky(all, d) - sum), 2e-3f * glm::length(sum));
  }
}

}  // namespace
}  // namespace h2mc
