// SPDX-License-Identifier: MIT
// Renders by the Metropolis methods, their parts and what they say of them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image_check.h"
#include "mcmc/render/integrator_choice.h"
#include "scene_files.h"

namespace h2mc {
namespace {

// A lamp that is seen, and beside it the wall that it lights; with a second lamp behind the camera.
constexpr const char* kLampAndWall = R"(<scene version="0.6.0">
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="toWorld"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="12"/>
      <integer name="height" value="8"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <shape type="rectangle">
    <transform name="toWorld"><scale value="4"/><translate z="-1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.5, 0.5"/></bsdf>
  </shape>
  <shape type="rectangle">
    <transform name="toWorld"><scale value="0.5"/><rotate y="1" angle="30"/></transform>
    <emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter>
  </shape>
  <shape type="rectangle">
    <transform name="toWorld"><rotate y="1" angle="180"/><translate z="6"/></transform>
    <emitter type="area"><rgb name="radiance" value="1, 1, 1"/></emitter>
  </shape>
</scene>)";

Scene lampAndWall() {
  static const testing::SceneFolder folder;
  return test::readTestScene(folder.write("scene.xml", kLampAndWall));
}

RenderResult render(const Scene& scene, const std::string& wish, long long perPixel) {
  RenderRequest request;
  request.budget.mutationsPerPixel = perPixel;
  request.threads = 2;
  return chooseIntegrator(wish, scene).integrator->render(scene, request);
}

// Where a source has no samples it has no noise.
TEST(Noise, OfEverySourceIsANumber) {
  const Scene scene = lampAndWall();
  for (const char* wish : {"mlt-1997", "mmlt-2014", "pssmlt-2002", "h2mc", "h2mc:baseSamples=0",
                           "lmc:baseSamples=2"}) {
    const RenderResult result = render(scene, wish, 8);
    for (const auto& [source, noise] : result.statistics.at("noise").items()) {
      EXPECT_TRUE(noise.is_number() && std::isfinite(noise.get<double>()))
          << wish << ": " << source;
      EXPECT_GE(noise.get<double>(), 0) << wish << ": " << source;
    }
  }
}

// Paths of one edge are lamps seen directly and nothing else: the wall is black.
TEST(MaxDepth, OneIsWhatTheCameraSees) {
  const Scene scene = lampAndWall();
  const Image path = render(scene, "path:maxDepth=1", 400).image;
  EXPECT_EQ(path.at(0, 0), Rgbf(0));
  EXPECT_NEAR(path.at(6, 4).x, 3, 1e-4);
  for (const char* wish :
       {"bdpt:maxDepth=1", "mmlt:maxDepth=1", "h2mc:maxDepth=1",
        "h2mc:maxDepth=1,directSamples=400", "mmlt:maxDepth=1,directSamples=0"}) {
    const RenderResult result = render(scene, wish, 400);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 12; ++x) {
        const double expected = path.at(x, y).x, pixel = result.image.at(x, y).x;
        // Lamp and wall share some pixels: there by chance. Chains alone have noise inside, too.
        EXPECT_NEAR(pixel, expected, expected > 0 ? 0.75 : 0) << wish << " " << x << " " << y;
      }
  }
}

// The lobes of a filter beside a lamp's border, on a wall that is all but black.
TEST(Pixels, AreNeverNegative) {
  std::string text = kLampAndWall;
  text.replace(text.find("\"box\""), 5, "\"catmullrom\"");
  text.replace(text.find("0.5, 0.5, 0.5"), 13, "0.001, 0.001, 0.001");
  const testing::SceneFolder folder;
  const Scene scene = test::readTestScene(folder.write("scene.xml", text));
  for (const char* wish : {"path", "bdpt", "mmlt", "h2mc:directSamples=0"}) {
    int black = 0;
    for (const Rgbf& pixel : render(scene, wish, 20).image.pixels) {
      ASSERT_TRUE(pixel.x >= 0 && pixel.y >= 0 && pixel.z >= 0) << wish;
      black += pixel == Rgbf(0);
    }
    EXPECT_GT(black, 2) << wish << ": the lobes are there";
  }
}

// Wherever a contribution is not finite it is counted, and the sum of all counts is the first thing that is said.
TEST(NotFinite, IsCountedWhereverItIsMet) {
  Scene scene = lampAndWall();
  ASSERT_EQ(scene.lights.size(), 2u);
  std::get<AreaLight>(scene.lights[1]).radiance = std::make_shared<const Texture>(
      ConstantTexture{Rgbf(std::numeric_limits<float>::infinity())});
  int withChains = 0;
  for (const char* wish :
       {"mmlt:chains=16,bootstrapSamples=2000,directSamples=4",
        "h2mc:chains=16,bootstrapSamples=2000,directSamples=0",
        "mmlt:chains=16,bootstrapSamples=2000,directSamples=0,largeStepProbability=1"}) {
    const RenderResult result = render(scene, wish, 20);
    for (const Rgbf& pixel : result.image.pixels)
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(pixel[c])) << wish;
    const nlohmann::json& statistics = result.statistics;
    const nlohmann::json& sources = statistics["not finite by source"];
    EXPECT_GT(sources["bootstrap"], 0) << wish;
    // Where paths are left to the chains; among theirs are the many connections of a bidirectional large step.
    if (statistics.contains("bootstrap")) {
      EXPECT_EQ(sources["bootstrap"], statistics["bootstrap"]["not finite"]);
      EXPECT_GT(sources["chains"], 0) << wish;
    }
    long long sum = 0;
    for (const auto& source : sources) sum += source.get<long long>();
    EXPECT_EQ(statistics["not finite"], sum) << wish;
    EXPECT_FALSE(statistics["first not finite"].get<std::string>().empty()) << wish;
    if (statistics.contains("direct lighting")) {
      EXPECT_GT(sources["direct lighting"], 0);
      EXPECT_EQ(sources["direct lighting"], statistics["direct lighting"]["not finite"]);
    }
    withChains += statistics.contains("bootstrap");
  }
  EXPECT_EQ(withChains, 2);
}

// Where no path can start, because none is finite, that is said as well.
TEST(NotFinite, IsCountedWhereNoChainCanStart) {
  Scene scene = lampAndWall();
  for (Light& light : scene.lights)
    std::get<AreaLight>(light).radiance = std::make_shared<const Texture>(
        ConstantTexture{Rgbf(std::numeric_limits<float>::infinity())});
  const RenderResult result =
      render(scene, "h2mc:chains=16,bootstrapSamples=2000,directSamples=4", 20);
  EXPECT_GT(result.statistics["not finite by source"]["bootstrap"], 0);
  EXPECT_GT(result.statistics["not finite"],
            result.statistics["direct lighting"]["not finite"].get<long long>());
}

}  // namespace
}  // namespace h2mc
