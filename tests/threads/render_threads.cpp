// SPDX-License-Identifier: MIT
// Renders on several threads: the same image as on one, marks and interruptions on the way. Under the preset tsan
// this is where data races show.
#include <gtest/gtest.h>

#include <atomic>
#include <cctype>
#include <cstring>

#include "image_check.h"
#include "mcmc/render/integrator_choice.h"
#include "motion_scenes.h"
#include "scene_files.h"

namespace h2mc {
namespace {

// By options that every method with chains understands; the others have none of them.
std::string quick(const IntegratorPlugin& plugin) {
  std::string wish(plugin.name);
  for (const Parameter& p : plugin.parameters)
    if (p.name == "bootstrapSamples") wish += ":bootstrapSamples=3000,chains=24,maxDepth=5";
  return wish;
}

RenderResult render(const Scene& scene, const std::string& wish, int threads,
                    RenderRequest request = {}) {
  request.threads = threads;
  request.seed = 5;
  if (request.budget.seconds == 0) request.budget.samplesPerPixel = 24;
  return chooseIntegrator(wish, scene).integrator->render(scene, request);
}

bool sameBytes(const Image& a, const Image& b) {
  return a.width == b.width && a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(a.pixels[0])) == 0;
}

Scene movingScene() {
  static const testing::SceneFolder folder;
  return test::readTestScene(folder.write("scene.xml", test::halfMovingScene(0, 1, true, 20, 15)));
}

class Threads : public ::testing::TestWithParam<IntegratorFactory> {};

TEST_P(Threads, SameImage) {
  const std::string wish = quick(GetParam().plugin);
  for (const Scene& scene :
       {test::readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 20, 15), movingScene()}) {
    std::atomic<int> marks{0}, steps{0};
    RenderRequest request;
    request.marks = {4, 12};
    request.atMark = [&](std::size_t, const RenderResult& so) {
      EXPECT_EQ(so.image.width, 20);
      ++marks;
    };
    request.progress = [&](const RenderProgress&) { ++steps; };
    const RenderResult many = render(scene, wish, 4, request);
    EXPECT_EQ(marks, 2);
    EXPECT_GT(steps, 0);
    const RenderResult one = render(scene, wish, 1, request);
    EXPECT_GT(one.meanLuminance, 0);
    EXPECT_TRUE(sameBytes(one.image, many.image)) << wish;
    EXPECT_EQ(one.samples, many.samples);
  }
}

TEST_P(Threads, EndWhenTheyAreStopped) {
  std::atomic<bool> stop{false};
  RenderRequest request;
  request.stop = &stop;
  request.budget.seconds = 600;
  request.progress = [&](const RenderProgress&) { stop = true; };
  const RenderResult result = render(movingScene(), quick(GetParam().plugin), 4, request);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.image.width, 20);
}

INSTANTIATE_TEST_SUITE_P(Of, Threads,
                         ::testing::ValuesIn(allIntegrators().begin(), allIntegrators().end()),
                         [](const auto& info) {
                           std::string name(info.param.plugin.name);
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace h2mc
