// SPDX-License-Identifier: MIT
// Lights of every kind, each with the shape it stands on, for tests.
#pragma once

#include <string>

#include "geometry_cases.h"
#include "render/light/light.h"

namespace h2mc::test {

struct LightCase {
  std::string name;
  Light light;
  std::vector<Shape> shapes;  // only the light's own
  SceneBounds bounds{Vec3f(0.2f, -0.1f, 0.3f), 4};

  LightContext context() const { return {shapes, bounds}; }
  bool isArea() const { return std::holds_alternative<AreaLight>(light); }
};

// Calls f with the light's own type.
template <class F>
decltype(auto) with(const LightCase& c, F&& f) {
  return std::visit(std::forward<F>(f), c.light);
}

inline TexturePtr checkers() {
  CheckerboardTexture t;
  t.color0 = Rgbf(1, 2, 4);
  t.color1 = Rgbf(0.5f, 0.1f, 0.2f);
  return std::make_shared<Texture>(t);
}

inline LightCase areaCase(std::string name, Shape shape, TexturePtr radiance = nullptr) {
  AreaLight light;
  light.radiance = radiance ? std::move(radiance) : constantTexture(Rgbf(1, 2, 3));
  light.shape = 0;
  LightCase c{std::move(name), light, {std::move(shape)}};
  prepareLights({&c.light, 1}, c.shapes);
  return c;
}

// A picture of random radiances over three orders of magnitude, some black pixels, and a sun.
inline Image sky(int width, int height) {
  Image image(width, height);
  Random random(9, 9, 9);
  for (Rgbf& p : image.pixels) {
    const float brightness = std::pow(10.0f, 3 * random.uniform() - 2);
    const float r = random.uniform(), g = random.uniform(), b = random.uniform();
    p = random.uniform() < 0.2f ? Rgbf(0) : Rgbf(r, g, b) * brightness;
  }
  image.at(width / 3, height / 3) = Rgbf(400, 350, 300);
  return image;
}

inline std::vector<LightCase> areaCases() {
  std::vector<LightCase> cases;
  const Vec3f a(-0.5f, 0.7f, 1.2f), e(1.1f, 0.2f, 0.1f), f(-0.1f, 0.4f, -1.3f);
  cases.push_back(areaCase("triangle", meshShape({a, a + e, a + f}, {{0, 1, 2}})));
  cases.push_back(areaCase("parallelogram", parallelogram(a, e, f)));
  cases.push_back(areaCase("textured", parallelogram(a, e, f), checkers()));
  cases.push_back(areaCase("flipped", parallelogram(a, f, e)));
  cases.push_back(areaCase("disk", disk(a, e, f)));
  cases.push_back(areaCase("sphere", sphere(a, 0.6f)));
  cases.push_back(areaCase("sphere inside out", sphere(Vec3f(0), 3, true)));
  cases.push_back(areaCase("ball", moved(ball(3, true), tilt(), 0.7f, a)));
  return cases;
}

inline std::vector<LightCase> infiniteCases() {
  std::vector<LightCase> cases;
  cases.push_back({"constant", ConstantLight{{}, Rgbf(1, 2, 3)}, {}});
  cases.push_back({"envmap", EnvmapLight(sky(16, 8), 2, tilt()), {}});
  cases.push_back(
      {"mirrored envmap", EnvmapLight(sky(9, 5), 2, glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)), {}});
  Image uniform(1, 1);
  uniform.at(0, 0) = Rgbf(0.5f);
  cases.push_back({"one pixel", EnvmapLight(uniform, 1, glm::mat3(1)), {}});
  const glm::dvec3 towards = glm::normalize(glm::dvec3(-0.3, 0.8, 0.4));
  cases.push_back({"sun", SunLight(towards, 0.3, Rgbf(3, 2, 1)), {}});
  cases.push_back({"half the sky", SunLight(towards, 1.57, Rgbf(1, 2, 3)), {}});
  return cases;
}

inline std::vector<LightCase> deltaCases() {
  std::vector<LightCase> cases;
  PointLight point;
  point.position = Vec3f(0.5f, 1.5f, -0.5f);
  point.intensity = Rgbf(3, 2, 1);
  cases.push_back({"point", point, {}});
  const Vec3f axis = glm::normalize(Vec3f(-0.4f, -1, 0.3f));
  cases.push_back({"spot", SpotLight(Vec3f(0.5f, 1.5f, -0.5f), axis, Rgbf(3, 2, 1), 50, 20), {}});
  cases.push_back(
      {"sharp spot", SpotLight(Vec3f(0.5f, 1.5f, -0.5f), axis, Rgbf(3, 2, 1), 30, 30), {}});
  cases.push_back(
      {"wide spot", SpotLight(Vec3f(0.5f, 1.5f, -0.5f), axis, Rgbf(3, 2, 1), 170, 0), {}});
  SpotLight projector(Vec3f(0.5f, 1.5f, -0.5f), axis, Rgbf(3, 2, 1), 50, 40);
  const Frame<float> across = Frame<float>::fromNormal(axis);
  auto slide = std::make_shared<Image>(3, 2);
  slide->pixels = {Rgbf(1, 0.2f, 0.5f), Rgbf(0.3f), Rgbf(0.9f), Rgbf(0.1f), Rgbf(1), Rgbf(0.4f)};
  BitmapTexture picture;
  picture.image = slide;
  projector.project(std::make_shared<const Texture>(picture), across.s, across.t);
  cases.push_back({"spot with a texture", projector, {}});
  cases.push_back({"projector",
                   ProjectorLight(Vec3f(0.5f, 1.5f, -0.5f),
                                  axis - across.s * 0.6f - across.t * 0.2f, across.s * 1.2f,
                                  across.t * 0.7f, std::make_shared<const Texture>(picture), 2),
                   {}});
  DirectionalLight directional;
  directional.direction = axis;
  directional.irradiance = Rgbf(1, 2, 0.5f);
  cases.push_back({"directional", directional, {}});
  return cases;
}

inline std::vector<LightCase> allCases() {
  std::vector<LightCase> all = areaCases();
  for (auto& c : infiniteCases()) all.push_back(c);
  for (auto& c : deltaCases()) all.push_back(c);
  return all;
}

}  // namespace h2mc::test
