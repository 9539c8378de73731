// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/image/image_io.h"
#include "render/light/light.h"
#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"
#include "render/scene/texel_check.h"

namespace h2mc {
namespace {

constexpr Parameter kSamplingWeight{"samplingWeight",
                                    ParameterType::kNumber,
                                    "1",
                                    "how often the light is chosen in other renderers",
                                    "",
                                    "",
                                    true};
constexpr Parameter kToWorld{"toWorld", ParameterType::kTransform, "",
                             "from the light to the world"};

constexpr std::array kAreaParameters{
    Parameter{"radiance", ParameterType::kTexture, "1", "radiance in every direction"},
    kSamplingWeight};
constexpr std::array kPointParameters{
    kToWorld, Parameter{"position", ParameterType::kPoint, "", "where it is, instead of toWorld"},
    Parameter{"intensity", ParameterType::kColor, "1", "flux per solid angle"}, kSamplingWeight};
constexpr std::array kSpotParameters{
    kToWorld,
    Parameter{"intensity", ParameterType::kColor, "1", "flux per solid angle in the beam"},
    Parameter{"cutoffAngle", ParameterType::kNumber, "20",
              "degrees from the axis to the dark, 0.001 to 180"},
    Parameter{"beamWidth", ParameterType::kNumber, "",
              "degrees from the axis to where the intensity starts to fall; 3/4 of cutoffAngle"},
    Parameter{"texture", ParameterType::kTexture, "",
              "a factor, projected: the whole of it at the cutoff; for angles below 90 degrees"},
    kSamplingWeight};
constexpr std::array kDirectionalParameters{
    kToWorld,
    Parameter{"direction", ParameterType::kVector, "",
              "the way the light goes, instead of toWorld"},
    Parameter{"irradiance", ParameterType::kColor, "1", "on a surface across the direction"},
    kSamplingWeight};
constexpr std::array kConstantParameters{
    Parameter{"radiance", ParameterType::kColor, "1", "radiance from every direction"},
    kSamplingWeight};
constexpr std::array kEnvmapParameters{
    Parameter{"filename", ParameterType::kString, "", "picture in latitude and longitude"},
    Parameter{"scale", ParameterType::kNumber, "1", "factor on the radiance"},
    kToWorld,
    Parameter{"gamma", ParameterType::kNumber, "0",
              "0: the file's own encoding, -1: sRGB, 1: linear, else value^gamma"},
    Parameter{"cache", ParameterType::kBoolean, "false", "other renderers' texture cache", "", "",
              true},
    Parameter{"misCompensation", ParameterType::kBoolean, "false", "how other renderers sample it",
              "", "", true},
    kSamplingWeight};

Vec3f transformVector(const Mat4& m, const Vec3f& v) { return glm::mat3(m) * v; }

// A unit vector along v, which the parameter gave.
Vec3f unit(const Properties& properties, std::string_view name, const Vec3f& v) {
  const glm::dvec3 d(v);
  const double length = std::sqrt(glm::dot(d, d));
  if (!(length > 0) || !std::isfinite(length))
    properties.fail(name, "expected a direction: a vector that is not zero");
  constexpr double kRounding = 1e-3;  // of directions written with few digits
  if (properties.given(name) && std::abs(length - 1) > kRounding)
    noteChange(properties, name, fmt::format("a direction of length {:g}", length), "of length 1");
  return Vec3f(d / length);
}

Light createArea(const Properties& properties) {
  AreaLight light;
  light.radiance = properties.texture("radiance");
  return light;
}

Light createPoint(const Properties& properties) {
  if (properties.given("position") && properties.given("toWorld"))
    properties.fail("position", "give either position or toWorld");
  PointLight light;
  light.position = properties.given("position") ? properties.vector("position")
                                                : Vec3f(properties.transform("toWorld")[3]);
  light.intensity = properties.color("intensity");
  return light;
}

Light createSpot(const Properties& properties) {
  const Mat4 toWorld = properties.transform("toWorld");
  const float cutoff = numberIn(properties, "cutoffAngle", 1e-3f, 180);
  const float beam =
      properties.given("beamWidth") ? properties.number("beamWidth") : cutoff * 0.75f;
  if (!(beam >= 0 && beam <= cutoff))
    properties.fail("beamWidth", "expected an angle from 0 to cutoffAngle");
  const auto across = [&](const Vec3f& axis) {
    return unit(properties, "toWorld", transformVector(toWorld, axis));
  };
  SpotLight light(Vec3f(toWorld[3]), across(Vec3f(0, 0, 1)), properties.color("intensity"), cutoff,
                  beam);
  if (properties.given("texture")) {
    if (!(cutoff < 90))
      properties.fail("texture", "a projected texture needs a cutoffAngle below 90");
    light.project(properties.texture("texture"), across(Vec3f(1, 0, 0)), across(Vec3f(0, 1, 0)));
  }
  return light;
}

Light createDirectional(const Properties& properties) {
  if (properties.given("direction") && properties.given("toWorld"))
    properties.fail("direction", "give either direction or toWorld");
  DirectionalLight light;
  light.direction = properties.given("direction")
                        ? unit(properties, "direction", properties.vector("direction"))
                        : unit(properties, "toWorld",
                               transformVector(properties.transform("toWorld"), Vec3f(0, 0, 1)));
  light.irradiance = properties.color("irradiance");
  return light;
}

Light createConstant(const Properties& properties) {
  return ConstantLight{properties.color("radiance")};
}

// What a transform does to directions: M = rotation * stretch, with a rotation (perhaps a reflection too)
// and a symmetric stretch, whose scale as a whole does not matter.
struct EnvironmentTransform {
  glm::dmat3 rotation{1}, stretch{1};
  bool stretches = false;
};

EnvironmentTransform environmentTransform(const Properties& properties) {
  constexpr double kNoise = 1e-3;  // of matrices written with few digits
  glm::dmat3 m(properties.transform("toWorld"));
  const double scale = std::cbrt(std::abs(glm::determinant(m)));
  if (!(scale > 0)) properties.fail("toWorld", "expected a transform that can be inverted");
  if (std::abs(scale - 1) > kNoise)
    noteChange(properties, "toWorld", fmt::format("a scale of {:g}", scale),
               "none: directions have no length");
  m = m * (1 / scale);
  EnvironmentTransform result;
  // Newton's iteration for the nearest orthogonal matrix [Higham 1986, "Computing the Polar
  // Decomposition"].
  result.rotation = m;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 next = (result.rotation + glm::transpose(glm::inverse(result.rotation))) * 0.5;
    double change = 0;
    for (int k = 0; k < 3; ++k)
      change = std::max(change, glm::length(next[k] - result.rotation[k]));
    result.rotation = next;
    if (change < 1e-14) break;
  }
  result.stretch = glm::transpose(result.rotation) * m;
  double deviation = 0;
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 identity(0);
    identity[k] = 1;
    deviation = std::max(deviation, glm::length(result.stretch[k] - identity));
  }
  result.stretches = deviation > kNoise;
  if (result.stretches)
    properties.warn("toWorld",
                    "the transform of the environment map stretches directions, by up to " +
                        std::to_string(static_cast<int>(std::ceil(100 * deviation))) + " %");
  return result;
}

// The picture as a rotation alone has to see it: at direction d it has what the original has at S^-1 d.
Image stretched(const Image& image, const glm::dmat3& stretch) {
  constexpr int kSub = 2;  // samples along a pixel's edge
  const glm::dmat3 inverse = glm::inverse(stretch);
  Image result(image.width, image.height);
  const auto lookUp = [&](double x, double y) {
    const double left = std::floor(x), top = std::floor(y), a = x - left, b = y - top;
    const auto texel = [&](double i, double j) {
      const int column = static_cast<int>(i) % image.width;
      return glm::dvec3(image.at(column < 0 ? column + image.width : column,
                                 std::clamp(static_cast<int>(j), 0, image.height - 1)));
    };
    return (texel(left, top) * (1 - a) + texel(left + 1, top) * a) * (1 - b) +
           (texel(left, top + 1) * (1 - a) + texel(left + 1, top + 1) * a) * b;
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::dvec3 sum(0);
      for (int k = 0; k < kSub * kSub; ++k) {
        const int column = k % kSub, row = k / kSub;
        const double u = (x + (column + 0.5) / kSub) / image.width;
        const double v = (y + (row + 0.5) / kSub) / image.height;
        const double phi = 2 * std::numbers::pi * u, theta = std::numbers::pi * v;
        const glm::dvec3 d = inverse * glm::dvec3(std::sin(phi) * std::sin(theta), std::cos(theta),
                                                  -std::cos(phi) * std::sin(theta));
        const double turn = std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
        const double fall = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
        sum += lookUp((turn < 0 ? turn + 1 : turn) * image.width - 0.5, fall * image.height - 0.5);
      }
      result.at(x, y) = Rgbf(sum / static_cast<double>(kSub * kSub));
    }
  return result;
}

Light createEnvmap(const Properties& properties) {
  const std::string file = properties.file("filename");
  const float scale = properties.number("scale");
  if (scale < 0) properties.fail("scale", "expected a number that is not negative");
  const EnvironmentTransform transform = environmentTransform(properties);
  Image image;
  try {
    image = readImage(file, readGamma(properties));
  } catch (const ImageError& error) {
    properties.fail("filename", error.what());
  }
  if (image.pixels.empty()) properties.fail("filename", "the picture is empty");
  if (auto mended = mendedTexels(properties, image)) image = *std::move(mended);
  for (const Rgbf& pixel : image.pixels)
    if (!ad::isFinite(pixel * scale))
      properties.fail("scale", "times the picture's values it is beyond float");
  if (transform.stretches) image = stretched(image, transform.stretch);
  return EnvmapLight(image, scale, glm::mat3(transform.rotation));
}

constexpr std::array kPlugins{
    Plugin<Light>{"area", "light from a shape's surface", kAreaParameters, createArea},
    Plugin<Light>{"point", "light from a point, the same in all directions", kPointParameters,
                  createPoint},
    Plugin<Light>{"spot", "light from a point into a cone around +z", kSpotParameters, createSpot},
    Plugin<Light>{"directional", "parallel light, along +z", kDirectionalParameters,
                  createDirectional},
    Plugin<Light>{"constant", "the same light from every direction", kConstantParameters,
                  createConstant},
    Plugin<Light>{"envmap", "light from infinitely far, from a picture in latitude and longitude",
                  kEnvmapParameters, createEnvmap}};

}  // namespace

std::span<const Plugin<Light>> lightPlugins() { return kPlugins; }

void prepareLights(std::span<Light> lights, std::span<const Shape> shapes) {
  for (Light& light : lights)
    if (auto* area = std::get_if<AreaLight>(&light)) area->prepare(shapes);
}

}  // namespace h2mc
