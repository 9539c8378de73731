// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "render/camera/camera.h"
#include "render/image/image_io.h"
#include "render/light/common_parameters.h"
#include "render/light/environment_transform.h"
#include "render/light/light.h"
#include "render/light/sky_plugins.h"
#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"
#include "render/scene/texel_check.h"

namespace h2mc {
namespace {

constexpr Parameter kToWorld{"toWorld", ParameterType::kTransform, "",
                             "from the light to the world"};

constexpr std::array kAreaParameters{
    Parameter{"radiance", ParameterType::kTexture, "1", "radiance in every direction"},
    kSamplingWeightParameter};
constexpr std::array kPointParameters{
    kToWorld, Parameter{"position", ParameterType::kPoint, "", "where it is, instead of toWorld"},
    Parameter{"intensity", ParameterType::kColor, "1", "flux per solid angle"},
    kSamplingWeightParameter};
constexpr std::array kSpotParameters{
    kToWorld,
    Parameter{"intensity", ParameterType::kColor, "1", "flux per solid angle in the beam"},
    Parameter{"cutoffAngle", ParameterType::kNumber, "20",
              "degrees from the axis to the dark, 0.001 to 180"},
    Parameter{"beamWidth", ParameterType::kNumber, "",
              "degrees from the axis to where the intensity starts to fall; 3/4 of cutoffAngle"},
    Parameter{"texture", ParameterType::kTexture, "",
              "a factor, projected: the whole of it at the cutoff; for angles below 90 degrees"},
    kSamplingWeightParameter};
constexpr std::array kProjectorParameters{
    Parameter{"irradiance", ParameterType::kTexture, "1",
              "the picture: over pi, the irradiance of a plane at unit distance"},
    Parameter{"scale", ParameterType::kNumber, "1", "a factor"},
    Parameter{"toWorld", ParameterType::kTransform, "", "from the light, which looks along +z"},
    Parameter{"fov", ParameterType::kNumber, "",
              "field of view, 1e-4 to 179.9 degrees; that of 50 mm for 35 mm film"},
    Parameter{"fovAxis", ParameterType::kString, "x",
              "the picture's axis that it is measured along", "x|y"},
    kSamplingWeightParameter};
constexpr std::array kDirectionalParameters{
    kToWorld,
    Parameter{"direction", ParameterType::kVector, "",
              "the way the light goes, instead of toWorld"},
    Parameter{"irradiance", ParameterType::kColor, "1", "on a surface across the direction"},
    kSamplingWeightParameter};
constexpr std::array kCollimatedParameters{
    Parameter{"toWorld", ParameterType::kTransform, "", "from the light, whose beam goes along +z"},
    Parameter{"power", ParameterType::kColor, "1", "flux of the whole beam"},
    kSamplingWeightParameter};
constexpr std::array kConstantParameters{
    Parameter{"radiance", ParameterType::kColor, "1", "radiance from every direction"},
    kSamplingWeightParameter};
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
    kSamplingWeightParameter};

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

// Width over height of a texture.
float aspectOf(const Texture& texture) {
  const auto* bitmap = std::get_if<BitmapTexture>(&texture);
  return bitmap
             ? static_cast<float>(bitmap->image->width) / static_cast<float>(bitmap->image->height)
             : 1;
}

Light createProjector(const Properties& properties) {
  const TexturePtr picture = properties.texture("irradiance");
  const float scale = properties.number("scale");
  if (scale < 0) properties.fail("scale", "expected a number that is not negative");
  const bool given = properties.given("fov");
  constexpr float kOfFilm = 46.7930f;  // degrees, of the diagonal
  const float fov = given ? numberIn(properties, "fov", 1e-4f, 179.9f) : kOfFilm;
  const auto axis = !given                                ? Camera::FovAxis::kDiagonal
                    : properties.string("fovAxis") == "y" ? Camera::FovAxis::kY
                                                          : Camera::FovAxis::kX;
  const Camera camera(properties.transform("toWorld"), fov, axis, aspectOf(*picture));
  // At unit distance, as a camera sees it.
  const auto at = [&](float u, float v) {
    const Vec3<double> d = camera.direction(double(u), double(v));
    return d / dot(d, Vec3<double>(camera.forward()));
  };
  const Vec3<double> corner = at(0, 0);
  return ProjectorLight(camera.position(), Vec3f(corner), Vec3f(at(1, 0) - corner),
                        Vec3f(at(0, 1) - corner), picture, scale);
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

Light createCollimated(const Properties& properties) {
  const Mat4 toWorld = properties.transform("toWorld");
  CollimatedLight light;
  light.position = Vec3f(toWorld[3]);
  light.direction = unit(properties, "toWorld", transformVector(toWorld, Vec3f(0, 0, 1)));
  light.flux = properties.color("power");
  return light;
}

Light createConstant(const Properties& properties) {
  return ConstantLight{{}, properties.color("radiance")};
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

constexpr std::array kOwnPlugins{
    Plugin<Light>{"area", "light from a shape's surface", kAreaParameters, createArea},
    Plugin<Light>{"point", "light from a point, the same in all directions", kPointParameters,
                  createPoint},
    Plugin<Light>{"spot", "light from a point into a cone around +z", kSpotParameters, createSpot},
    Plugin<Light>{"projector", "a picture thrown from a point, as a camera would take it",
                  kProjectorParameters, createProjector},
    Plugin<Light>{"directional", "parallel light, along +z", kDirectionalParameters,
                  createDirectional},
    Plugin<Light>{"collimated", "a beam without width, along +z: bdpt and what has chains find it",
                  kCollimatedParameters, createCollimated},
    Plugin<Light>{"constant", "the same light from every direction", kConstantParameters,
                  createConstant},
    Plugin<Light>{"envmap", "light from infinitely far, from a picture in latitude and longitude",
                  kEnvmapParameters, createEnvmap}};

}  // namespace

std::span<const Plugin<Light>> lightPlugins() {
  static const std::vector<Plugin<Light>> all = [] {
    std::vector<Plugin<Light>> list(kOwnPlugins.begin(), kOwnPlugins.end());
    list.insert(list.end(), skyPlugins().begin(), skyPlugins().end());
    return list;
  }();
  return all;
}

void prepareLights(std::span<Light> lights, std::span<const Shape> shapes) {
  for (Light& light : lights)
    if (auto* area = std::get_if<AreaLight>(&light)) area->prepare(shapes);
}

}  // namespace h2mc
