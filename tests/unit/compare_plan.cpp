// SPDX-License-Identifier: MIT
// What a comparison makes of its command line, of external images and of pixels for the page.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "compare/embed.h"
#include "compare/external.h"
#include "compare/measure.h"
#include "render/core/random.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"
#include "scene_files.h"

namespace h2mc {
namespace {

TEST(ComparisonPlan, SplitsMethodsAndTheirOptions) {
  EXPECT_EQ(splitMethods("path,h2mc:sigma=0.1,lensSigma=0.02,mmlt"),
            (std::vector<std::string>{"path", "h2mc:sigma=0.1,lensSigma=0.02", "mmlt"}));
  EXPECT_EQ(splitMethods("h2mc,h2mc:sigma=0.1"),
            (std::vector<std::string>{"h2mc", "h2mc:sigma=0.1"}));
  EXPECT_THROW(splitMethods("path,,mmlt"), ComparisonError);
  EXPECT_THROW(splitMethods("path,path"), ComparisonError);
}

TEST(ComparisonPlan, Marks) {
  EXPECT_EQ(parseMarks("5,10,20.5"), (std::vector<double>{5, 10, 20.5}));
  for (const char* wrong : {"", "5,", "10,5", "5,5", "-1", "0", "x", "5 10", "inf", "nan"})
    EXPECT_THROW(parseMarks(wrong), ComparisonError) << wrong;
}

TEST(ComparisonPlan, ScenesHaveNamesOfTheirOwn) {
  const auto scenes = namedScenes({"a/scene.xml", "b/scene.xml", "ring.xml"});
  EXPECT_EQ(scenes[0].name, "scene");
  EXPECT_EQ(scenes[1].name, "scene-2");
  EXPECT_EQ(scenes[2].name, "ring");
  EXPECT_EQ(fileNameFor("h2mc:sigma=0.1,x=a/b"), "h2mc_sigma=0.1,x=a_b");
  EXPECT_EQ(fileNameFor(".."), "_..");
}

TEST(ExternalImages, TimeInTheName) {
  EXPECT_EQ(secondsInName("ring-2.5s-a"), 2.5);
  EXPECT_EQ(secondsInName("torus_10s"), 10);
  EXPECT_EQ(secondsInName("ring2-40sec"), 40);
  EXPECT_FALSE(secondsInName("ring2-seed4"));
  EXPECT_FALSE(secondsInName("ring-256spp"));
}

TEST(ExternalImages, RepeatsAndMistakes) {
  const h2mc::testing::SceneFolder folder;
  SceneRuns scene;
  scene.scene = {"ring.xml", "ring"};
  scene.width = 4;
  scene.height = 3;
  const ExternalMethod method{"other", folder.path()};
  EXPECT_THROW(readExternal(method, scene, true), ComparisonError);  // nothing there
  for (const char* name : {"ring-1s-a.exr", "ring-1s-b.exr", "ring-2s-a.exr", "ring-2s-b.exr"})
    writeImage(folder.path() + name, Image(4, 3));
  writeImage(folder.path() + "ring-late.exr", Image(4, 3),
             {{"wallSeconds", 8.0}, {"samples", 120.0}});
  writeImage(folder.path() + "cup-1s.exr", Image(4, 3));
  const MethodRuns runs = readExternal(method, scene, false);
  ASSERT_EQ(runs.repeats.size(), 2u);
  EXPECT_EQ(runs.repeats[0].points.size(), 3u);
  EXPECT_EQ(runs.repeats[1].points.size(), 2u);
  EXPECT_EQ(runs.repeats[0].points[2].seconds, 8);
  EXPECT_EQ(runs.repeats[0].points[2].perPixel, 10);
  EXPECT_EQ(runs.repeats[1].points[0].image.filename(), "ring-1s-b.exr");
  writeImage(folder.path() + "ring-x.exr", Image(4, 3));
  EXPECT_THROW(readExternal(method, scene, false), ComparisonError);  // no time
  writeImage(folder.path() + "ring-x.exr", Image(5, 3));
  EXPECT_THROW(readExternal(method, scene, false), ComparisonError);  // another size
}

// Too bright by 5 %, 5 % too bright here and too dark there, and only noisy.
TEST(Bias, ShowsBehindTheScatter) {
  const h2mc::testing::SceneFolder folder;
  Image reference(32, 32);
  for (Rgbf& p : reference.pixels) p = Rgbf(1);
  for (const auto& [upper, lower] : {std::pair{0.0, 0.0}, {0.05, 0.05}, {0.05, -0.05}}) {
    MethodRuns method;
    for (int k = 0; k < 4; ++k) {
      Random random(11, static_cast<std::uint64_t>(k), upper > 0);
      Image image = reference;
      for (int i = 0; i < 32 * 32; ++i)
        image.pixels[i] = Rgbf(
            static_cast<float>(1 + (i < 512 ? upper : lower) + 0.3 * (random.uniform() - 0.5)));
      Point point;
      point.image = folder.path() + "image" + std::to_string(k) + ".exr";
      point.meanRatio = meanLuminance(image);
      writeImage(point.image.string(), image);
      method.repeats.push_back({static_cast<std::uint64_t>(k), {point}});
    }
    const BiasCheck check = checkBias(method, reference, {});
    EXPECT_EQ(check.shows, upper != lower);
    EXPECT_EQ(check.brightnessOff, upper + lower != 0);
    const double squared = (upper * upper + lower * lower) / 2;
    EXPECT_NEAR(check.squaredBias, squared / 1.01, 6e-4);
    EXPECT_NEAR(check.varianceAlone, 0.09 / 12 / 4 / 1.01, 2e-4);
    EXPECT_NEAR(check.meanImageError, check.varianceAlone + squared / 1.01, 6e-4);
    ReferenceFacts doubtful;
    doubtful.brightness = 0.04;
    EXPECT_FALSE(checkBias(method, reference, doubtful).brightnessOff);
  }
}

TEST(Page, Halves) {
  const auto value = [](std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const double v =
        exponent ? std::ldexp(1024 + mantissa, exponent - 25) : std::ldexp(mantissa, -24);
    return bits & 0x8000 ? -v : v;
  };
  EXPECT_EQ(halfBits(0), 0);
  EXPECT_EQ(halfBits(1), 0x3c00);
  EXPECT_EQ(halfBits(-2), 0xc000);
  EXPECT_EQ(halfBits(65504), 0x7bff);
  EXPECT_EQ(halfBits(1e9f), 0x7bff);
  EXPECT_EQ(halfBits(std::ldexp(1.f, -24)), 1);
  EXPECT_EQ(halfBits(std::nanf("")) & 0x7c00, 0x7c00);
  Random random(1, 2, 3);
  for (int i = 0; i < 10000; ++i) {
    const float x = std::ldexp(1 + random.uniform(), static_cast<int>(i % 30) - 14);
    EXPECT_NEAR(value(halfBits(x)), x, x * std::ldexp(1, -11)) << x;
  }
}

TEST(Page, Base64) {
  const auto encoded = [](const std::string& text) {
    return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace h2mc
