// SPDX-License-Identifier: MIT
// Derivatives with respect to the point of a thin lens that a path goes through.
#include <gtest/gtest.h>

#include <cmath>

#include "check/gradcheck/gradcheck.h"
#include "exactness_scenes.h"
#include "render/path/path_text.h"
#include "render/path/replay_double.h"
#include "sampled_paths.h"

namespace h2mc::test {
namespace {

struct LensScene {
  const char* name;
  std::string xml;
  bool moves;
};

std::ostream& operator<<(std::ostream& out, const LensScene& scene) { return out << scene.name; }

class ApertureDerivative : public ::testing::TestWithParam<LensScene> {
 protected:
  testing::SceneFolder folder_;
  Scene scene_ = folder_.read(GetParam().xml);
};

// All entries against finite differences, by the templates in double and by all forms in float.
TEST_P(ApertureDerivative, AgreesWithFiniteDifferences) {
  GradcheckSettings settings;
  settings.paths = 400;
  settings.maxLength = 5;
  settings.seed = 3;
  settings.threads = 2;
  int judged = 0, moving = 0;
  for (const PathCheck& p : gradcheck(scene_, settings).paths) {
    EXPECT_FALSE(p.failed()) << pathText(p.path.technique, p.path.sample);
    judged += p.agree > 0;
    moving += p.traits.moving;
  }
  EXPECT_GT(judged, 300);
  EXPECT_EQ(moving > 0, GetParam().moves);
}

// The aperture matters for most paths, whatever their technique, and its coordinates are where they should be.
TEST_P(ApertureDerivative, SeesTheAperture) {
  int paths = 0, bySeeing = 0, byConnection = 0, gradientsApart = 0;
  forSampledPaths(scene_, 5, 40, 4000, [&](const Path& path, float) {
    ASSERT_TRUE(path.aperture);
    ASSERT_EQ(path.dimension(), path.technique.dimension() + 2 + path.moving);
    Derivative d;
    differentiate(scene_, path, d);
    ASSERT_EQ(d.dimension, path.dimension());
    if (!d.finite()) return;
    double u[kMaxCoordinates];
    pathCoordinates(path, u);
    const int a = path.apertureCoordinate();
    EXPECT_EQ(static_cast<float>(u[a]), path.sample.aperture[0]);
    const double step = 1e-4, here = u[a];
    if (!(here > step && here < 1 - step)) return;
    u[a] = here + step;
    const double more = replayInDouble(scene_, path, u);
    u[a] = here - step;
    const double slope = (more - replayInDouble(scene_, path, u)) / (2 * step);
    if (!std::isfinite(slope)) return;
    ++paths;
    (path.technique.t == 1 ? byConnection : bySeeing) += std::abs(d.gradient[a]) > 1e-3;
    Gradient gradient;
    differentiateOnce(scene_, path, gradient);
    const double allowed = 1e-2 * std::max(1.0, std::abs(slope));
    gradientsApart += std::abs(d.gradient[a] - slope) > allowed ||
                      std::abs(gradient.gradient[a] - slope) > allowed;
  });
  std::printf("%d paths, %d seeing and %d connecting through the lens; %d apart\n", paths, bySeeing,
              byConnection, gradientsApart);
  EXPECT_GT(bySeeing, 100);
  EXPECT_GT(byConnection, 10);
  EXPECT_LE(gradientsApart, paths / 50);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ApertureDerivative,
    ::testing::Values(LensScene{"glass", withThinLens(glassScene(), 0.15, 4), false},
                      LensScene{"moving", withThinLens(halfMovingScene(0, 1, true), 0.2, 6), true}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace h2mc::test
