// SPDX-License-Identifier: MIT
#include "mcmc/populations/bootstrap.h"

#include <gtest/gtest.h>

#include <map>

#include "image_check.h"
#include "mcmc/render/integrator_choice.h"

namespace h2mc {
namespace {

Scene ring() { return test::readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 24, 18); }

std::map<std::vector<float>, int> starts(const Bootstrap& bootstrap, int count) {
  std::map<std::vector<float>, int> seen;
  Path start(4);
  for (int i = 0; i < count; ++i) {
    Random random(5, 6, static_cast<std::uint64_t>(i));
    bootstrap.drawStart((i + 0.5) / count, random, start);
    const float* u = start.sample.u.data();
    ++seen[{u, u + start.technique.dimension()}];
  }
  return seen;
}

// In parts that are no whole blocks, by another number of threads.
TEST(Bootstrap, ExtendedIsAsIfMadeAtOnce) {
  const Scene scene = ring();
  const Bootstrap whole(scene, 2, 4, 20000, 3, 2);
  Bootstrap parts(scene, 2, 4, 1000, 3, 1);
  const double before = parts.luminance().mean();
  parts.extendTo(500);
  EXPECT_EQ(parts.luminance().count, 1000);
  parts.extendTo(9001);
  parts.extendTo(20000);
  EXPECT_EQ(parts.luminance().count, 20000);
  EXPECT_NE(parts.luminance().mean(), before);
  EXPECT_EQ(parts.luminance().mean(), whole.luminance().mean());
  EXPECT_EQ(parts.luminance().variance(), whole.luminance().variance());
  EXPECT_EQ(parts.notFinite(), whole.notFinite());
  // Blocks are summed in other portions.
  const auto near = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-12 * b[k]) << k;
  };
  near(parts.techniqueLuminance(), whole.techniqueLuminance());
  near(parts.techniqueSquares(), whole.techniqueSquares());
  EXPECT_EQ(starts(parts, 50), starts(whole, 50));
}

// What a long render has more of.
TEST(Bootstrap, GrowsWithTheRender) {
  const Scene scene = ring();
  const auto samples = [&](const char* options, long long mutationsPerPixel) -> long long {
    RenderRequest request;
    request.budget.mutationsPerPixel = mutationsPerPixel;
    request.threads = 2;
    return chooseIntegrator(std::string("mmlt:maxDepth=3,directSamples=1") + options, scene)
        .integrator->render(scene, request)
        .statistics["bootstrap"]["samples"];
  };
  EXPECT_EQ(samples("", 16), 100000);
  // 0.02 of the mutations.
  EXPECT_EQ(samples("", 12000), 12000 * 24 * 18 / 50);
  EXPECT_EQ(samples(",bootstrapSamples=3000", 16), 3000);
}

}  // namespace
}  // namespace h2mc
