#include <array>
#include <cmath>

#include "render/image/image_io.h"
#include "render/light/light.h"
#include "render/scene/properties.h"

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
    Parameter{"cutoffAngle", ParameterType::kNumber, "20", "degrees from the axis to the dark"},
    Parameter{"beamWidth", ParameterType::kNumber, "",
              "degrees from the axis to where the intensity starts to fall; 3/4 of cutoffAngle"},
    Parameter{"texture", ParameterType::kTexture, "", "not supported"},
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
    kSamplingWeight};

Vec3f transformVector(const Mat4& m, const Vec3f& v) { return glm::mat3(m) * v; }

// A unit vector along v, which the parameter gave.
Vec3f unit(const Properties& properties, std::string_view name, const Vec3f& v) {
  const glm::dvec3 d(v);
  const double length = std::sqrt(glm::dot(d, d));
  if (!(length > 0) || !std::isfinite(length))
    properties.fail(name, "expected a direction: a vector that is not zero");
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
  if (properties.given("texture"))
    properties.fail("texture", "spot lights with a texture are not supported");
  const Mat4 toWorld = properties.transform("toWorld");
  const float cutoff = properties.number("cutoffAngle");
  if (!(cutoff > 0 && cutoff <= 180))
    properties.fail("cutoffAngle", "expected an angle above 0 and up to 180 degrees");
  const float beam =
      properties.given("beamWidth") ? properties.number("beamWidth") : cutoff * 0.75f;
  if (!(beam >= 0 && beam <= cutoff))
    properties.fail("beamWidth", "expected an angle from 0 to cutoffAngle");
  return SpotLight(Vec3f(toWorld[3]),
                   unit(properties, "toWorld", transformVector(toWorld, Vec3f(0, 0, 1))),
                   properties.color("intensity"), cutoff, beam);
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

// The rotation (and reflection) of a transform that may scale uniformly.
glm::mat3 rotationOf(const Properties& properties, const Mat4& transform) {
  glm::dmat3 m(transform);
  const double scale = std::cbrt(std::abs(glm::determinant(m)));
  if (!(scale > 0)) properties.fail("toWorld", "expected a transform that can be inverted");
  m = m * (1 / scale);
  const glm::dmat3 product = glm::transpose(m) * m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(product[i][j] - (i == j ? 1 : 0)) < 1e-3))
        properties.fail("toWorld", "an environment map can be rotated and mirrored, not sheared");
  // One step of Newton's iteration for the nearest orthogonal matrix.
  return glm::mat3((m + glm::transpose(glm::inverse(m))) * 0.5);
}

Light createEnvmap(const Properties& properties) {
  const std::string file = properties.file("filename");
  const float scale = properties.number("scale");
  if (scale < 0) properties.fail("scale", "expected a number that is not negative");
  const glm::mat3 toWorld = rotationOf(properties, properties.transform("toWorld"));
  Image image;
  try {
    image = readImage(file, properties.number("gamma"));
  } catch (const ImageError& error) {
    properties.fail("filename", error.what());
  }
  if (image.pixels.empty()) properties.fail("filename", "the picture is empty");
  for (Rgbf& pixel : image.pixels) {
    if (!ad::isFinite(pixel * scale))
      properties.fail("filename", "the picture has pixels that are not finite");
    pixel = glm::max(pixel, Rgbf(0));
  }
  return EnvmapLight(image, scale, toWorld);
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
