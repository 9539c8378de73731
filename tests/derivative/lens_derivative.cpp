// SPDX-License-Identifier: MIT
// The derivatives with respect to the film position against the lens perturbation itself: between two
// paths that it leads to from one another, the log of target and density must change by what gradient
// and Hessian say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mcmc/mutations/lens_step.h"
#include "mcmc/render/integrators.h"
#include "render/path/lens_replay.h"
#include "render/scene/scene_reader.h"
#include "sampled_paths.h"

namespace h2mc {
namespace {

struct Case {
  const char* name;
  std::string file;
  double threshold;  // of the lens perturbation: above a lobe's width it is traced through
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class LensDerivative : public testing::TestWithParam<Case> {};

TEST_P(LensDerivative, PredictsTheStep) {
  if (!std::filesystem::exists(GetParam().file))
    GTEST_SKIP() << "NOT TESTED: no scene at " << GetParam().file;
  constexpr int kLength = 5, kSteps = 8;
  ReadOptions options;
  std::vector<IntegratorPlugin> plugins;
  for (const IntegratorFactory& f : allIntegrators()) plugins.push_back(f.plugin);
  options.integrators = plugins;
  const Scene scene = readScene(GetParam().file, options);
  const ImportanceMap everywhere;
  const SceneTarget target(scene, kLength, everywhere);
  LensStep::Settings settings;
  SlotNumbers slots;
  settings.threshold = static_cast<float>(GetParam().threshold);
  ChainState current(kLength), proposed(kLength);
  Random random(3, 1, 4);
  MutationContext context;
  context.random = &random;

  int paths = 0, predicted = 0, wrong = 0, notFinite = 0;
  test::forSampledPaths(scene, kLength, 30, 4000, [&](const Path& path, float) {
    if (path.technique.t < 2) return;
    ++paths;
    Derivative d;
    {
      const LensStep step(target, settings, slots);
      differentiateLens(scene, path, step.reconnectionVertex(path), d);
    }
    if (!d.finite()) {
      ++notFinite;
      return;
    }
    EXPECT_EQ(d.dimension, 2);
    // A step over which the log changes by about a tenth, but no longer than a pixel or so.
    const double slope = std::hypot(d.gradient[0], d.gradient[1]),
                 curvature = std::max(
                     {std::abs(d.hessian[0]), std::abs(d.hessian[1]), std::abs(d.hessian[2])});
    settings.hamiltonian.sigma = static_cast<float>(
        std::min({2e-3, 0.1 / (slope + 1e-9), 0.3 / std::sqrt(curvature + 1e-9)}));
    LensStep step(target, settings, slots);
    current.forget();
    current.path = path;
    for (int i = 0; i < kSteps; ++i) {
      proposed.forget();
      const Proposal proposal = step.propose(current, proposed, context);
      if (!proposal.made()) continue;
      const double actual =
          std::log(double(proposed.path.target) / path.target) + proposal.logRatio();
      const double x = double(proposed.path.sample.u[0]) - path.sample.u[0],
                   y = double(proposed.path.sample.u[1]) - path.sample.u[1];
      const double linear = d.gradient[0] * x + d.gradient[1] * y;
      const double quadratic =
          0.5 * (d.hessian[0] * x * x + 2 * d.hessian[1] * x * y + d.hessian[2] * y * y);
      ++predicted;
      wrong += !(std::abs(actual - linear - quadratic) <=
                 0.01 + 0.15 * (std::abs(linear) + std::abs(quadratic)));
    }
  });
  std::printf("%s: %d paths, %d steps, %d not as predicted; %d not finite\n", GetParam().name,
              paths, predicted, wrong, notFinite);
  EXPECT_GT(predicted, 200);
  // Steps across the edges of triangles, texels and fields.
  EXPECT_LE(wrong, predicted / 12);
  EXPECT_LE(notFinite, paths / 50);
}

std::vector<Case> cases() {
  const std::string data = H2MC_DATA_DIR, own = H2MC_SOURCE_DIR;
  return {{"ring", own + "/scenes/ring/ring.xml", 0.1},
          {"ringThroughAll", own + "/scenes/ring/ring.xml", 2},
          {"plastic", data + "/crosscheck/plastic.xml", 0.1},
          {"roughdielectric", data + "/crosscheck/roughdielectric.xml", 0.1},
          {"envmap", data + "/crosscheck/envmap.xml", 0.1}};
}

INSTANTIATE_TEST_SUITE_P(Scenes, LensDerivative, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc
