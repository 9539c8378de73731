// SPDX-License-Identifier: MIT
// A beam of light: what only paths from it find.
#include <gtest/gtest.h>

#include "mcmc/render/direct_lighting.h"
#include "render/core/index.h"
#include "render/path/assemble.h"
#include "render/path/path_densities.h"
#include "sampled_paths.h"
#include "scene_files.h"
#include "tiny_render.h"

namespace h2mc::test {
namespace {

CollimatedLight beam() {
  CollimatedLight light;
  light.position = Vec3f(0.5f, 1.5f, -0.5f);
  light.direction = glm::normalize(Vec3f(-0.4f, -1, 0.3f));
  light.flux = Rgbf(3, 2, 1);
  return light;
}

TEST(CollimatedLight, SendsAllItsLightOneWay) {
  const CollimatedLight light = beam();
  const LightContext context{{}, {Vec3f(0), 4}};
  for (const float u : {0.f, 0.3f, 0.9f}) {
    const auto e = light.sampleEmission<float>(context, {}, u, 1 - u, u, 0.4f);
    EXPECT_EQ(e.origin, light.position);
    EXPECT_EQ(e.direction, light.direction);
    EXPECT_EQ(e.flux, light.flux);
    EXPECT_EQ(e.emissionPdf, 1);
    EXPECT_EQ(e.directPdf, 0);
  }
  // Nothing arrives anywhere, not even on the beam.
  for (const Vec3f& at : {Vec3f(1, 0, 0), light.position + light.direction * 2.f, light.position}) {
    const auto d = light.sampleDirect<float>(context, {}, at, 0.5f, 0.5f);
    EXPECT_EQ(d.arriving, Rgbf(0));
    EXPECT_EQ(d.directPdf, 0);
  }
}

TEST(CollimatedLight, KnowsItsRays) {
  const CollimatedLight light = beam();
  const LightContext context{{}, {Vec3f(0), 4}};
  Vec2f u, v;
  float choice;
  EXPECT_TRUE(light.invertEmission(context, {}, light.position, light.direction, u, v, choice));
  const Vec3f across = glm::normalize(glm::cross(light.direction, Vec3f(1, 0, 0)));
  EXPECT_FALSE(light.invertEmission(
      context, {}, light.position, glm::normalize(light.direction + across * 0.02f), u, v, choice));
  EXPECT_FALSE(light.invertEmission(context, {}, light.position + across * 0.02f, light.direction,
                                    u, v, choice));
  EXPECT_FALSE(light.invertDirect(context, {}, Vec3f(0), light.direction, 1, u, choice));
  EXPECT_TRUE(light.reaches(light.position + light.direction * 2.f));
  EXPECT_FALSE(light.reaches(light.position - light.direction * 2.f));
  EXPECT_FALSE(light.reaches(light.position + light.direction * 2.f + across * 1e-4f));
}

// A beam straight down onto a grey floor, seen from above at an angle.
Scene spotOnTheFloor() {
  testing::SceneFolder folder;
  return folder.read(R"(<scene version="0.6.0"><sensor type="perspective">
<transform name="toWorld"><lookat origin="0, 3, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
<float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="16"/>
<integer name="height" value="12"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="2"/><rotate x="1" angle="-90"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
<emitter type="collimated"><transform name="toWorld"><lookat origin="0.2, 2, 0.1" target="0.2, 0, 0.1" up="1, 0, 0"/>
</transform><rgb name="power" value="3, 2, 1"/></emitter></scene>)");
}

// The mean of the picture, by hand: flux * reflectance / pi * |cos| * the camera's importance / distance^2.
double meanByHand(const Scene& scene) {
  const Vec3f spot(0.2f, 0, 0.1f), way = spot - scene.camera.position();
  const double d2 = dot(way, way), d = std::sqrt(d2);
  const double cosine = dot(way, scene.camera.forward()) / d, floor = -way.y / d;
  return luminance(Rgbf(3, 2, 1)) * 0.6 / std::numbers::pi * floor *
         double(scene.camera.pdf(static_cast<float>(cosine))) / d2;
}

TEST(CollimatedLight, ItsSpotIsInThePicture) {
  const Scene scene = spotOnTheFloor();
  const double expected = meanByHand(scene);
  ASSERT_GT(expected, 0);
  EXPECT_EQ(DirectLighting::longest(scene), 1);
  const auto meanOf = [&](const char* integrator) {
    RenderRequest request;
    request.seed = 3;
    request.threads = 1;
    const RenderResult result =
        renderTiny(integrator, scene, request,
                   {{"maxDepth", "2"}, {"samplesPerPixel", "4"}, {"mutationsPerPixel", "4"}});
    double sum = 0;
    int lit = 0;
    for (const Rgbf& pixel : result.image.pixels) {
      sum += luminance(pixel);
      lit += luminance(pixel) > 0;
    }
    EXPECT_LE(lit, 1) << integrator;
    return sum / static_cast<double>(result.image.pixels.size());
  };
  // One path, and it is always the same.
  EXPECT_NEAR(meanOf("bdpt"), expected, 1e-4 * expected);
  // How often the chains' bootstrap asks for the technique is drawn.
  EXPECT_NEAR(meanOf("mmlt"), expected, 0.1 * expected);
  EXPECT_NEAR(meanOf("h2mc"), expected, 0.1 * expected);
  EXPECT_EQ(meanOf("path"), 0);
}

// What the beam falls on first can't be moved, however little.
TEST(CollimatedLight, ItsFirstVertexStaysWhereItIs) {
  const Scene scene = spotOnTheFloor();
  FullPath path;
  int found = 0;
  forSampledPaths(scene, 2, 5, 2000, [&](const Path& traced, float) {
    ASSERT_TRUE(toFull(scene, traced, path));
    const TechniqueDensities here = densities(scene, path);
    EXPECT_EQ(here.weight[2], 1);
    EXPECT_NEAR(here.target(2), traced.target, 1e-5 * traced.target);
    ++found;
    Random random(5, 1, 2);
    Path again(2);
    EXPECT_TRUE(assemble(scene, path, {2, 1}, kNoEdge, random, again));
    FullPath moved = path;
    moved.x[1].point.p.x += 1e-3f;
    const TechniqueDensities there = densities(scene, moved);
    EXPECT_EQ(luminance(there.color), 0);
    for (int s = 0; s <= 2; ++s) EXPECT_EQ(there.weight[at(s)], 0);
  });
  EXPECT_GT(found, 0);
}

// Beside others it is not asked for direct light.
TEST(CollimatedLight, IsNotAskedForDirectLight) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(R"(<scene version="0.6.0"><sensor type="perspective"/>
<shape type="rectangle"><transform name="toWorld"><translate z="3"/></transform></shape>
<emitter type="collimated"/><emitter type="point"><point name="position" x="0" y="1" z="1"/></emitter></scene>)");
  EXPECT_EQ(scene.directPicker.probability(0), 0);
  EXPECT_GT(scene.emissionPicker.probability(0), 0);
}

}  // namespace
}  // namespace h2mc::test
