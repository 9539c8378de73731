// SPDX-License-Identifier: MIT
#include "render/light/sky_plugins.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/light/common_parameters.h"
#include "render/light/environment_transform.h"
#include "render/light/sky_model.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"

namespace h2mc {
namespace {

constexpr Parameter kTurbidity{"turbidity", ParameterType::kNumber, "3",
                               "how much haze there is, 1 to 10"};
constexpr Parameter kAlbedo{"albedo", ParameterType::kColor, "0.2",
                            "of the ground, which lights the sky, 0 to 1"};
constexpr Parameter kSunDirection{"sunDirection", ParameterType::kVector, "",
                                  "towards the sun, in the world; instead of place and time"};
constexpr Parameter kYear{"year", ParameterType::kInteger, "2010", "of the date"};
constexpr Parameter kMonth{"month", ParameterType::kInteger, "7", "of the date, 1 to 12"};
constexpr Parameter kDay{"day", ParameterType::kInteger, "10", "of the date, 1 to 31"};
constexpr Parameter kHour{"hour", ParameterType::kNumber, "15", "of the local time"};
constexpr Parameter kMinute{"minute", ParameterType::kNumber, "0", "of the local time"};
constexpr Parameter kSecond{"second", ParameterType::kNumber, "0", "of the local time"};
constexpr Parameter kLatitude{"latitude", ParameterType::kNumber, "35.6894", "degrees north"};
constexpr Parameter kLongitude{"longitude", ParameterType::kNumber, "139.6917", "degrees east"};
constexpr Parameter kTimezone{"timezone", ParameterType::kNumber, "9",
                              "hours before Greenwich's time"};
constexpr Parameter kStretch{
    "stretch", ParameterType::kNumber, "1",
    "factor on angles to the zenith, 1 to 2: 2 covers the ground's half too"};
constexpr Parameter kExtend{"extend", ParameterType::kBoolean, "false",
                            "the horizon's light goes on below it, fading towards the nadir"};
constexpr Parameter kResolution{"resolution", ParameterType::kInteger, "512",
                                "width of the picture that stands for the sky, 8 to 2048 pixels"};
constexpr Parameter kScale{"scale", ParameterType::kNumber, "1", "factor on the radiance"};
constexpr Parameter kSunScale{"sunScale", ParameterType::kNumber, "",
                              "factor on the sun's radiance; scale"};
constexpr Parameter kSkyScale{"skyScale", ParameterType::kNumber, "",
                              "factor on the sky's radiance; scale"};
constexpr Parameter kSunRadiusScale{"sunRadiusScale", ParameterType::kNumber, "1",
                                    "factor on the sun's radius, up to 300, which leaves its light "
                                    "as much as it is; below 0.001: all of it from one direction"};
constexpr Parameter kSunAperture{
    "sunAperture", ParameterType::kNumber, "",
    "instead of sunRadiusScale: the sun's apparent diameter, 0.001 to 160 degrees"};
constexpr Parameter kSkyToWorld{"toWorld", ParameterType::kTransform, "",
                                "from the sky, where +y is up, to the world"};
constexpr Parameter kSunskyAlbedo{
    "albedo", ParameterType::kColor, "0.2",
    "of the ground, which lights the sky, 0 to 1; from version 2 on 0.3"};
constexpr Parameter kSunskyToWorld{
    "toWorld", ParameterType::kTransform, "",
    "from the sky, where +y is up, to the world; from version 2 on +z is up, +x is south"};
constexpr Parameter kSunResolution{"resolution", ParameterType::kInteger,
                                   "512",        "of a picture that other renderers make of it",
                                   "",           "",
                                   true};

constexpr std::array kSkyParameters{
    kTurbidity, kAlbedo, kSunDirection, kYear,     kMonth,      kDay,
    kHour,      kMinute, kSecond,       kLatitude, kLongitude,  kTimezone,
    kStretch,   kExtend, kResolution,   kScale,    kSkyToWorld, kSamplingWeightParameter};
constexpr std::array kSunParameters{kTurbidity,
                                    kSunDirection,
                                    kYear,
                                    kMonth,
                                    kDay,
                                    kHour,
                                    kMinute,
                                    kSecond,
                                    kLatitude,
                                    kLongitude,
                                    kTimezone,
                                    kStretch,
                                    kScale,
                                    kSunRadiusScale,
                                    kSkyToWorld,
                                    kSunResolution,
                                    kSamplingWeightParameter};
constexpr std::array kSunskyParameters{kTurbidity,      kSunskyAlbedo,
                                       kSunDirection,   kYear,
                                       kMonth,          kDay,
                                       kHour,           kMinute,
                                       kSecond,         kLatitude,
                                       kLongitude,      kTimezone,
                                       kStretch,        kExtend,
                                       kResolution,     kScale,
                                       kSunScale,       kSkyScale,
                                       kSunRadiusScale, kSunAperture,
                                       kSunskyToWorld,  kSamplingWeightParameter};

// Which of the plugins it is: version 3 has "sunsky" alone, with another frame and other defaults.
enum class Kind { kSingle, kSunsky };
bool isRecent(const Properties& p, Kind kind) { return kind == Kind::kSunsky && !p.isOldVersion(); }

// To the world from the frame of the model, where +y is up, east is +x and north is -z. In files of version 3 the
// sky's own has +z up, south along +x and west along +y.
EnvironmentTransform skyTransform(const Properties& p, Kind kind) {
  EnvironmentTransform transform = environmentTransform(p);
  if (!isRecent(p, kind)) return transform;
  const glm::dmat3 toRecent(0, -1, 0, 0, 0, 1, 1, 0, 0);  // by columns
  transform.rotation = transform.rotation * toRecent;
  transform.stretch = glm::transpose(toRecent) * transform.stretch * toRecent;
  return transform;
}

// Where the sky's own frame puts the sun: unit, above the horizon.
glm::dvec3 sunDirection(const Properties& p, const EnvironmentTransform& transform) {
  constexpr const char* kDate[] = {"year",   "month",    "day",       "hour",    "minute",
                                   "second", "latitude", "longitude", "timezone"};
  glm::dvec3 sun;
  if (p.given("sunDirection")) {
    for (const char* name : kDate)
      if (p.given(name)) p.fail(name, "give either sunDirection or place and time");
    const glm::dvec3 local =
        glm::inverse(transform.matrix()) * glm::dvec3(p.vector("sunDirection"));
    const double length = std::sqrt(glm::dot(local, local));
    if (!(length > 0)) p.fail("sunDirection", "expected a direction: a vector that is not zero");
    sun = local / length;
  } else {
    PlaceAndTime when;
    when.latitude = numberIn(p, "latitude", -90, 90);
    when.longitude = numberIn(p, "longitude", -360, 360);
    when.timezone = numberIn(p, "timezone", -24, 24);
    when.year = integerIn(p, "year", 1900, 2100);
    when.month = integerIn(p, "month", 1, 12);
    when.day = integerIn(p, "day", 1, 31);
    when.hour = numberIn(p, "hour", 0, 24);
    when.minute = numberIn(p, "minute", 0, 60);
    when.second = numberIn(p, "second", 0, 60);
    sun = sunDirectionAt(when);
  }
  if (sun.y < 0)
    p.fail(
        p.given("sunDirection") ? "sunDirection" : "hour",
        fmt::format("the sun is {:.3g} degrees below the horizon, where the model of the sky has "
                    "no light",
                    std::asin(-sun.y) * 180 / kPiD));
  return sun;
}

// The direction with this angle to the zenith and this azimuth.
glm::dvec3 directionAt(double theta, double phi) {
  return {std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
}

float scaleOf(const Properties& p, std::string_view own) {
  const std::string_view name = !own.empty() && p.given(own) ? own : "scale";
  const float scale = p.number(name);
  if (scale < 0) p.fail(name, "expected a number that is not negative");
  return scale;
}

void requireFinite(const Properties& p, const Rgbf& radiance) {
  if (!ad::isFinite(radiance)) p.fail("scale", "times the model's radiance it is beyond float");
}

Light makeSky(const Properties& p, float scale, Kind kind) {
  const EnvironmentTransform transform = skyTransform(p, kind);
  const Rgbf albedo = isRecent(p, kind) && !p.given("albedo") ? Rgbf(0.3f) : p.color("albedo");
  if (std::max({albedo.x, albedo.y, albedo.z}) > 1) p.fail("albedo", "expected values from 0 to 1");
  const double stretch = numberIn(p, "stretch", 1, 2);
  const bool extend = p.boolean("extend");
  const int width = integerIn(p, "resolution", 8, 2048), height = width / 2;
  const SkyModel model(numberIn(p, "turbidity", 1, 10), albedo, sunDirection(p, transform));
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    const double along = (y + 0.5) / height * kPiD;
    double theta = along / stretch, fade = 1;
    if (theta >= kPiD / 2) {
      if (!extend) continue;
      theta = kPiD / 2;
    }
    if (extend) {
      const double x = std::clamp(2 - 2 * along / kPiD, 0.0, 1.0);
      fade = x * x * (3 - 2 * x);
    }
    for (int x = 0; x < width; ++x)
      image.at(x, y) = model.radiance(directionAt(theta, 2 * kPiD * (x + 0.5) / width)) *
                       static_cast<float>(fade);
  }
  for (const Rgbf& pixel : image.pixels) requireFinite(p, pixel * scale);
  if (transform.stretches) image = stretched(image, transform.stretch);
  return EnvmapLight(image, scale, glm::mat3(transform.rotation));
}

// Of the sun's radius over what it is.
double sunRadiusScale(const Properties& p, Kind kind) {
  constexpr float kLargest = 300, kLargestAperture = 160, kSmallestAperture = 1e-3f;
  if (kind == Kind::kSingle || !p.given("sunAperture"))
    return numberIn(p, "sunRadiusScale", 0, kLargest);
  if (p.given("sunRadiusScale")) p.fail("sunAperture", "give either sunAperture or sunRadiusScale");
  const double aperture = numberIn(p, "sunAperture", kSmallestAperture, kLargestAperture);
  return aperture / 2 * (kPiD / 180) / kSunRadius;
}

Light makeSun(const Properties& p, float scale, Kind kind) {
  if (isRecent(p, kind) && scale > 0)
    p.warn("sunScale",
           "the sun is Preetham et al.'s and not that of Hosek and Wilkie 2013, which "
           "version 3 has: its brightness and colour are somewhat different");
  const EnvironmentTransform transform = skyTransform(p, kind);
  const glm::dvec3 sun = sunDirection(p, transform);
  const double zenith = std::acos(std::min(sun.y, 1.0));
  const double azimuth = std::atan2(sun.x, -sun.z);
  const glm::dvec3 direction = glm::normalize(
      transform.matrix() * directionAt(zenith * numberIn(p, "stretch", 1, 2), azimuth));
  const Rgbf radiance = sunRadiance(zenith, numberIn(p, "turbidity", 1, 10)) * scale;
  requireFinite(p, radiance);
  const auto capOf = [](double radius) { return 2 * std::pow(std::sin(radius / 2), 2); };
  constexpr double kSmallest = 1e-3;  // an arc second: nobody sees that it is a disc
  const double radiusScale = sunRadiusScale(p, kind);
  const double radius = radiusScale * kSunRadius;
  if (radiusScale < kSmallest) {
    DirectionalLight light;
    light.direction = -Vec3f(direction);
    light.irradiance = radiance * static_cast<float>(2 * kPiD * capOf(kSunRadius));
    return light;
  }
  const Rgbf onDisc = radiance * static_cast<float>(capOf(kSunRadius) / capOf(radius));
  requireFinite(p, onDisc);
  return SunLight(direction, radius, onDisc);
}

constexpr std::array kPlugins{
    Plugin<Light>{"sky", "the clear sky's light [Hosek and Wilkie 2012]", kSkyParameters,
                  [](const Properties& p) { return makeSky(p, scaleOf(p, ""), Kind::kSingle); }},
    Plugin<Light>{"sun", "the sun's light through clear air [Preetham et al. 1999]", kSunParameters,
                  [](const Properties& p) { return makeSun(p, scaleOf(p, ""), Kind::kSingle); }},
    Plugin<Light>{"sunsky", "sun and sky", kSunskyParameters, [](const Properties& p) {
                    return makeSky(p, scaleOf(p, "skyScale"), Kind::kSunsky);
                  }}};

}  // namespace

std::span<const Plugin<Light>> skyPlugins() { return kPlugins; }

Light sunOfSunsky(const Properties& properties) {
  return makeSun(properties, scaleOf(properties, "sunScale"), Kind::kSunsky);
}

}  // namespace h2mc
