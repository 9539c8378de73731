// SPDX-License-Identifier: MIT
// Motion blur: against static images in the mean, and the integrators against each other.
#include "image_check.h"
#include "motion_scenes.h"
#include "render/core/random.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

constexpr int kEdge = 10, kRuns = 16;

Scene read(const h2mc::testing::SceneFolder& folder, double open, double close, bool camera) {
  return readTestScene(folder.write("scene.xml", halfMovingScene(open, close, camera)));
}

// Means and squared standard errors of runs, for expectAgreement.
void statistics(const Runs& runs, std::vector<double>& mean, std::vector<double>& variance) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    mean.push_back(runs.mean(k));
    variance.push_back(runs.variance(k));
  }
}

TEST(MotionImage, SlowIsTheMeanOfStaticOnes) {
  constexpr int kStrata = 8, kSamples = 4;
  constexpr double kOpen = 0.1, kClose = 0.9;
  const h2mc::testing::SceneFolder folder;
  Random random(1, 2, 3);
  std::vector<Scene> scenes;
  Runs still;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> sum;
    for (int i = 0; i < kStrata; ++i) {
      const double time = kOpen + (kClose - kOpen) * (i + random.uniformDouble()) / kStrata;
      const Scene scene = read(folder, time, time, true);
      EXPECT_FALSE(scene.moving);
      for (const IntegratorFactory& factory : allIntegrators()) {
        if (factory.plugin.name != "path") continue;
        OptionSet options(factory.plugin);
        options.set("maxDepth", "4");
        RenderRequest request;
        request.budget.samplesPerPixel = kSamples;
        request.seed = static_cast<std::uint64_t>(1000 + run * kStrata + i);
        const auto blocks =
            blockMeans(factory.create(options)->render(scene, request).image, kEdge);
        sum.resize(blocks.size());
        for (std::size_t k = 0; k < blocks.size(); ++k) sum[k] += blocks[k] / kStrata;
      }
    }
    still.blocks.push_back(sum);
  }
  std::vector<double> mean, variance;
  statistics(still, mean, variance);
  const Scene scene = read(folder, kOpen, kClose, true);
  EXPECT_TRUE(scene.moving);
  expectAgreement(renderRuns(scene, "path", {}, kRuns, kStrata * kSamples, kEdge), mean, variance,
                  8e-3, "moving path against static ones");
}

class HalfMoving : public ::testing::TestWithParam<bool> {};

TEST_P(HalfMoving, SlowIntegratorsAgree) {
  const h2mc::testing::SceneFolder folder;
  const Scene scene = read(folder, 0, 1, GetParam());
  std::vector<double> mean, variance;
  statistics(renderRuns(scene, "bdpt", {}, kRuns, 20, kEdge), mean, variance);
  const std::vector<std::pair<std::string, std::string>> chains{
      {"bootstrapSamples", "15000"}, {"directSamples", "0"}, {"chains", "128"}};
  for (const char* integrator : {"path", "mmlt", "h2mc"}) {
    const bool path = std::string(integrator) == "path";
    expectAgreement(renderRuns(scene, integrator, path ? decltype(chains)() : chains, kRuns,
                               path ? 40 : 16, kEdge),
                    mean, variance, 1e-2, std::string("half-moving ") + integrator);
  }
}

INSTANTIATE_TEST_SUITE_P(Camera, HalfMoving, ::testing::Values(false, true), [](const auto& info) {
  return std::string(info.param ? "MovingCamera" : "StillCamera");
});

}  // namespace
}  // namespace h2mc::test
