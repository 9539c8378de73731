// SPDX-License-Identifier: MIT
// Lights as scene files make them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <variant>

#include "light_cases.h"
#include "render/image/image_io.h"
#include "render/scene/properties.h"

namespace h2mc {
namespace {

using Value = std::variant<float, std::string, Rgbf, Mat4>;

// Parameters without a file, checked against the plugin's table.
class TableProperties : public Properties {
 public:
  TableProperties(const Plugin<Light>& plugin, std::map<std::string, Value, std::less<>> values)
      : plugin_(plugin), values_(std::move(values)) {}

  bool given(std::string_view name) const override {
    parameter(name);
    return values_.contains(name);
  }
  bool boolean(std::string_view) const override { return false; }
  int integer(std::string_view name) const override { return static_cast<int>(number(name)); }
  float number(std::string_view name) const override {
    if (given(name)) return std::get<float>(values_.find(name)->second);
    return std::stof(std::string(fallback(name)));
  }
  std::string string(std::string_view name) const override {
    return std::get<std::string>(values_.find(name)->second);
  }
  Rgbf color(std::string_view name) const override {
    if (given(name)) return std::get<Rgbf>(values_.find(name)->second);
    return Rgbf(std::stof(std::string(fallback(name))));
  }
  TexturePtr texture(std::string_view name) const override { return constantTexture(color(name)); }
  Vec3f vector(std::string_view name) const override { return color(name); }
  Mat4 transform(std::string_view name) const override {
    return given(name) ? std::get<Mat4>(values_.find(name)->second) : Mat4(1);
  }
  std::string file(std::string_view name) const override { return string(name); }
  int nestedBsdfCount() const override { return 0; }
  int nestedBsdf(int) const override { return -1; }
  const Material& material(int) const override { throw std::logic_error("no materials"); }
  [[noreturn]] void fail(std::string_view name, const std::string& message) const override {
    throw SceneError(std::string(name) + ": " + message);
  }

 private:
  const Parameter& parameter(std::string_view name) const {
    for (const Parameter& p : plugin_.parameters)
      if (p.name == name) return p;
    throw std::logic_error("not in the table: " + std::string(name));
  }
  std::string_view fallback(std::string_view name) const {
    const Parameter& p = parameter(name);
    if (p.fallback.empty()) fail(name, "no default");
    return p.fallback;
  }

  const Plugin<Light>& plugin_;
  std::map<std::string, Value, std::less<>> values_;
};

Light make(std::string_view type, std::map<std::string, Value, std::less<>> values = {}) {
  for (const Plugin<Light>& plugin : lightPlugins())
    if (plugin.name == type) return plugin.create(TableProperties(plugin, std::move(values)));
  throw std::logic_error("no such light");
}

Mat4 rotationAboutY(float degrees, float scale = 1) {
  const float a = glm::radians(degrees), c = std::cos(a) * scale, s = std::sin(a) * scale;
  Mat4 m(scale);
  m[0] = {c, 0, -s, 0};
  m[2] = {s, 0, c, 0};
  m[3] = {1, 2, 3, 1};
  return m;
}

template <class L>
auto direct(const Light& light, const Vec3f& reference) {
  const SceneBounds bounds{Vec3f(0), 10};
  return std::get<L>(light).template sampleDirect<float>(LightContext{{}, bounds}, {}, reference,
                                                         0.3f, 0.6f);
}

TEST(LightPlugins, Defaults) {
  EXPECT_EQ(average(*std::get<AreaLight>(make("area")).radiance), Rgbf(1));
  EXPECT_EQ(std::get<PointLight>(make("point")).position, Vec3f(0));
  EXPECT_EQ(std::get<PointLight>(make("point")).intensity, Rgbf(1));
  EXPECT_EQ(std::get<DirectionalLight>(make("directional")).direction, Vec3f(0, 0, 1));
  EXPECT_EQ(std::get<ConstantLight>(make("constant")).radiance, Rgbf(1));
  // Spot: 20 degrees, falling from 15.
  const Light spot = make("spot");
  const auto at = [&](float degrees) {
    const float a = glm::radians(degrees);
    return direct<SpotLight>(spot, Vec3f(std::sin(a), 0, std::cos(a))).arriving.x;
  };
  EXPECT_FLOAT_EQ(at(14.9f), 1);
  EXPECT_NEAR(at(17.5f), 0.5f, 1e-4f);
  EXPECT_EQ(at(20.1f), 0);
}

TEST(LightPlugins, Places) {
  EXPECT_EQ(std::get<PointLight>(make("point", {{"position", Rgbf(4, 5, 6)}})).position,
            Vec3f(4, 5, 6));
  EXPECT_EQ(std::get<PointLight>(make("point", {{"toWorld", rotationAboutY(30)}})).position,
            Vec3f(1, 2, 3));
  const Light directional = make("directional", {{"direction", Rgbf(0, -2, 0)}});
  EXPECT_EQ(std::get<DirectionalLight>(directional).direction, Vec3f(0, -1, 0));
  const Light turned = make("directional", {{"toWorld", rotationAboutY(90, 3)}});
  EXPECT_NEAR(std::get<DirectionalLight>(turned).direction.x, 1, 1e-6f);
  // A spot light at (1, 2, 3) that looks along +x.
  const Light spot = make("spot", {{"toWorld", rotationAboutY(90, 2)}, {"intensity", Rgbf(8)}});
  EXPECT_EQ(direct<SpotLight>(spot, Vec3f(3, 2, 3)).arriving, Rgbf(2));
  EXPECT_FLOAT_EQ(direct<SpotLight>(spot, Vec3f(3, 2, 3)).directPdf, 4);
  EXPECT_EQ(direct<SpotLight>(spot, Vec3f(1, 2, 5)).arriving, Rgbf(0));
}

// On a plane across its axis, and nothing beside the picture.
TEST(LightPlugins, ProjectorsLightPlanesEvenly) {
  const Light projector =
      make("projector", {{"irradiance", Rgbf(2)}, {"scale", 3.f}, {"fov", 90.f}, {"fovAxis", "x"}});
  for (const float x : {-3.9f, -1.f, 0.f, 2.f, 3.9f})
    for (const float y : {-3.9f, 0.f, 3.f}) {
      const auto d = direct<ProjectorLight>(projector, Vec3f(x, y, 4));
      EXPECT_NEAR(d.arriving.x * 4 / d.distance, 6 * kPi / 16, 1e-5f) << x << " " << y;
    }
  for (const Vec3f& p : {Vec3f(4.1f, 0, 4), Vec3f(0, -4.1f, 4), Vec3f(0, 0, -4), Vec3f(4, 0, 0)})
    EXPECT_EQ(direct<ProjectorLight>(projector, p).arriving, Rgbf(0));
  const Light film = make("projector");
  const float edge = std::tan(glm::radians(46.793f / 2)) / std::sqrt(2.f);
  EXPECT_GT(direct<ProjectorLight>(film, Vec3f(0.999f * edge, 0, 1)).arriving.x, 0);
  EXPECT_EQ(direct<ProjectorLight>(film, Vec3f(1.001f * edge, 0, 1)).arriving.x, 0);
}

TEST(LightPlugins, Mistakes) {
  EXPECT_THROW(make("spot", {{"texture", Rgbf(1)}, {"cutoffAngle", 90.f}}), SceneError);
  EXPECT_THROW(make("spot", {{"cutoffAngle", 0.f}}), SceneError);
  EXPECT_THROW(make("spot", {{"cutoffAngle", 200.f}}), SceneError);
  EXPECT_THROW(make("spot", {{"beamWidth", 30.f}}), SceneError);
  EXPECT_THROW(make("spot", {{"toWorld", Mat4(0)}}), SceneError);
  EXPECT_THROW(make("directional", {{"direction", Rgbf(0)}}), SceneError);
  EXPECT_THROW(make("point", {{"position", Rgbf(0)}, {"toWorld", Mat4(1)}}), SceneError);
}

TEST(LightPlugins, Envmap) {
  const std::string file = (std::filesystem::temp_directory_path() /
                            ("light_plugins_" + std::to_string(getpid()) + ".exr"))
                               .string();
  Image image = test::sky(32, 16);
  writeImage(file, image);
  const auto radiance = [](const Light& l, const Vec3f& d) {
    return std::get<EnvmapLight>(l)
        .hit<float>(LightContext{{}, {Vec3f(0), 1}}, SurfacePoint<float>{}, glm::normalize(d))
        .radiance;
  };
  const Light plain = make("envmap", {{"filename", file}});
  const Light turned =
      make("envmap", {{"filename", file}, {"scale", 3.f}, {"toWorld", rotationAboutY(40, 5)}});
  const Vec3f d(0.3f, 0.4f, 0.7f);
  const Rgbf a = radiance(plain, d), b = radiance(turned, glm::mat3(rotationAboutY(40)) * d);
  EXPECT_LT(glm::length(b - a * 3.0f), 1e-3f * glm::length(b));

  // Stretched, sheared and turned: along M d there is what was along d.
  Mat4 stretched(1);
  stretched[0] = {1.5f, 0, 0, 0};
  stretched[1] = {0.2f, 1, 0, 0};
  const Mat4 m = rotationAboutY(40) * stretched;
  image = Image(512, 256);  // smooth
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float phi = 2 * std::numbers::pi_v<float> * (static_cast<float>(x) + 0.5f) / 512;
      const float theta = std::numbers::pi_v<float> * (static_cast<float>(y) + 0.5f) / 256;
      image.at(x, y) = Rgbf(1 + 0.9f * std::sin(phi) * std::sin(theta), 1 + 0.9f * std::cos(theta),
                            1 - 0.9f * std::cos(phi) * std::sin(theta));
    }
  writeImage(file, image);
  const Light fine = make("envmap", {{"filename", file}});
  const Light warped = make("envmap", {{"filename", file}, {"toWorld", m}});
  for (const Vec3f& v : {Vec3f(0.3f, 0.4f, 0.7f), Vec3f(-0.6f, 0.1f, 0.2f), Vec3f(0.1f, -1, 0)}) {
    const Rgbf there = radiance(fine, v), here = radiance(warped, glm::mat3(m) * v);
    EXPECT_LT(glm::length(here - there), 1e-3f * glm::length(there));
  }
  EXPECT_THROW(make("envmap", {{"filename", file}, {"toWorld", Mat4(0)}}), SceneError);
  EXPECT_THROW(make("envmap", {{"filename", file}, {"scale", -1.f}}), SceneError);
  std::filesystem::remove(file);
  EXPECT_THROW(make("envmap", {{"filename", file}}), SceneError);
}

TEST(LightPlugins, Collimated) {
  const Light light = make("collimated", {{"toWorld", rotationAboutY(90, 1)}, {"power", Rgbf(4)}});
  const auto& beam = std::get<CollimatedLight>(light);
  EXPECT_EQ(beam.position, Vec3f(1, 2, 3));
  EXPECT_LT(glm::distance(beam.direction, Vec3f(1, 0, 0)), 1e-6f);
  EXPECT_EQ(beam.flux, Rgbf(4));
  EXPECT_NEAR(beam.power({}), 4, 1e-6);
  EXPECT_TRUE(isBeam(light));
  EXPECT_THROW(make("collimated", {{"toWorld", Mat4(0)}}), SceneError);
}

// Every table says what create() asks for.
TEST(LightPlugins, TablesAreComplete) {
  // "sky" and "sunsky" make an envmap.
  EXPECT_EQ(lightPlugins().size(), std::variant_size_v<Light> + 2);
  for (const Plugin<Light>& plugin : lightPlugins()) {
    EXPECT_FALSE(plugin.description.empty());
    for (const Parameter& p : plugin.parameters) EXPECT_FALSE(p.description.empty()) << p.name;
    if (plugin.name != "envmap") {
      EXPECT_NO_THROW(make(plugin.name));
    }
  }
}

}  // namespace
}  // namespace h2mc
