// The contribution's derivatives against finite differences of the same contribution in double, on
// paths of every technique; and the frozen topology against what was traced.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ad/finite_difference.h"
#include "mcmc/integrators.h"
#include "render/path/derivative.h"
#include "render/path/replay.h"
#include "render/scene/scene_reader.h"
#include "sampled_paths.h"

namespace h2mc {
namespace {

struct Case {
  const char* name;
  std::string file;
  int maxLength;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  const std::string data = H2MC_DATA_DIR, own = H2MC_SOURCE_DIR;
  return {{"ring", own + "/scenes/ring/ring.xml", 8},
          {"torus", data + "/torus/torus.xml", 8},
          {"bathroom", data + "/bathroom/bathroom.xml", 6},
          {"envmap", data + "/crosscheck/envmap.xml", 5},
          {"roughdielectric", data + "/crosscheck/roughdielectric.xml", 5},
          {"dielectric", data + "/crosscheck/dielectric_constant.xml", 5},
          {"plastic", data + "/crosscheck/plastic.xml", 4},
          {"roughplastic", data + "/crosscheck/roughplastic.xml", 4},
          {"beckmann", data + "/crosscheck/roughconductor_beckmann.xml", 4},
          {"point", data + "/crosscheck/checker_point.xml", 4}};
}

class PathDerivative : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(GetParam().file))
      GTEST_SKIP() << "NOT TESTED: no scene at " << GetParam().file;
    ReadOptions options;
    std::vector<IntegratorPlugin> plugins;
    for (const IntegratorFactory& f : allIntegrators()) plugins.push_back(f.plugin);
    options.integrators = plugins;
    scene_ = std::make_unique<Scene>(readScene(GetParam().file, options));
  }

  // Calls visit(path) for up to `perTechnique` traced paths of each technique.
  template <class Visit>
  void forPaths(int perTechnique, int samples, Visit&& visit) {
    techniques_ =
        test::forSampledPaths(*scene_, std::min(GetParam().maxLength, H2MC_DERIVATIVE_EDGES),
                              perTechnique, samples, [&](const Path& path, float sampled) {
                                EXPECT_EQ(path.target, sampled) << "replayed";
                                visit(path);
                              });
  }

  std::unique_ptr<Scene> scene_;
  std::size_t techniques_ = 0;
};

TEST_P(PathDerivative, FrozenTopologyGivesTheTracedValue) {
  int checked = 0, apart = 0;
  forPaths(40, 4000, [&](const Path& path) {
    const double traced = std::log(double(path.target));
    EXPECT_NEAR(replayLogTarget<float>(*scene_, path, path.sample.u.data()), traced, 1e-4);
    // Double starts from the same coordinates; sharp lobes, their far tails above all, and long
    // paths magnify float's rounding.
    double u[2 * kMaxPathLength];
    std::copy_n(path.sample.u.begin(), path.technique.dimension(), u);
    const double exact = replayLogTarget<double>(*scene_, path, u);
    apart += !(std::abs(exact - traced) <= 0.02);
    ++checked;
  });
  EXPECT_GT(checked, 100);
  EXPECT_GT(techniques_, 5u);
  EXPECT_LE(apart, checked / 50) << "paths whose value in float and in double differ by 2 %";
}

TEST_P(PathDerivative, SlowAgreesWithFiniteDifferences) {
  int judged = 0, unjudged = 0, wrong = 0, notFinite = 0;
  int wrongBefore = 0;
  forPaths(6, 2000, [&](const Path& path) {
    const int n = path.technique.dimension();
    Derivative d;
    ASSERT_TRUE(differentiate(*scene_, path, d));
    if (!d.finite()) {
      ++notFinite;
      return;
    }
    double u[kMaxDerivativeDimension];
    std::copy_n(path.sample.u.begin(), n, u);
    // Two sweeps of steps, a hundred times apart. Where a texel's or a triangle's border lies within
    // the larger one they disagree, and nothing can be judged.
    const auto f = [&](const double* x) { return replayLogTarget<double>(*scene_, path, x); };
    const auto fd = ad::finiteDifferences(f, u, n, 1e-5);
    const auto wide = ad::finiteDifferences(f, u, n, 1e-3);
    double gradientScale = 1, hessianScale = 1;
    for (int i = 0; i < n; ++i)
      gradientScale = std::max(gradientScale, double(std::abs(d.gradient[i])));
    for (int i = 0; i < n * (n + 1) / 2; ++i)
      hessianScale = std::max(hessianScale, double(std::abs(d.hessian[i])));
    for (int i = 0, k = 0; i < n; ++i) {
      const auto& g = fd.gradient[static_cast<std::size_t>(i)];
      const auto& g2 = wide.gradient[static_cast<std::size_t>(i)];
      if (std::max(g.error, std::abs(g.value - g2.value)) <= 1e-3 * gradientScale) {
        ++judged;
        wrong += !(std::abs(d.gradient[i] - g.value) <= 1e-2 * gradientScale + 10 * g.error);
      } else {
        ++unjudged;
      }
      for (int j = 0; j <= i; ++j, ++k) {
        const auto& h = fd.hessian[static_cast<std::size_t>(i * n + j)];
        const auto& h2 = wide.hessian[static_cast<std::size_t>(i * n + j)];
        if (std::max(h.error, std::abs(h.value - h2.value)) <= 1e-2 * hessianScale) {
          ++judged;
          wrong += !(std::abs(d.hessian[k] - h.value) <= 2e-2 * hessianScale + 10 * h.error);
        } else {
          ++unjudged;
        }
      }
    }
    if (wrong > wrongBefore)
      std::printf("wrong: s=%d t=%d, log target %g, %d entries, largest %g\n", path.technique.s,
                  path.technique.t, std::log(double(path.target)), wrong - wrongBefore,
                  hessianScale);
    wrongBefore = wrong;
  });
  std::printf("%s: %d entries judged, %d not, %d wrong; %d paths not finite\n", GetParam().name,
              judged, unjudged, wrong, notFinite);
  EXPECT_GT(judged, 500);
  // Where a kink lies inside the differences' steps they can be confident and wrong.
  EXPECT_LE(wrong, judged / 200);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathDerivative, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc
