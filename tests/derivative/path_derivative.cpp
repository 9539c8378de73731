// SPDX-License-Identifier: MIT
// The contribution's derivatives against finite differences of the same contribution in double, on
// paths of every technique; and the frozen topology against what was traced.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "check/gradcheck/gradcheck.h"
#include "mcmc/render/integrators.h"
#include "render/core/index.h"
#include "render/path/derivative.h"
#include "render/path/path_text.h"
#include "render/path/replay.h"
#include "render/path/replay_double.h"
#include "render/scene/scene_reader.h"
#include "sampled_paths.h"

namespace h2mc {
namespace {

constexpr int kPaths = 150;  // of each scene, checked against differences

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
    techniques_ = test::forSampledPaths(*scene_, GetParam().maxLength, perTechnique, samples,
                                        [&](const Path& path, float sampled) {
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

// The vertex-local form against the plain one, both in double, so that nothing but a mistake can part
// them.
TEST_P(PathDerivative, LocalFormIsThePlainOne) {
  int checked = 0;
  double worst = 0;
  techniques_ =
      test::forSampledPaths(*scene_, GetParam().maxLength, 10, 3000, [&](const Path& path, float) {
        double u[kMaxCoordinates];
        pathCoordinates(path, u);
        const auto plain = differentiateInDouble(*scene_, path, u);
        const auto local = differentiateLocallyInDouble(*scene_, path, u);
        if (!plain.finite()) return;
        ++checked;
        EXPECT_NEAR(local.value, plain.value, 1e-8);
        const int n = path.dimension();
        const auto scale = [&](int i) {
          const auto diagonal = at(ad::triangleIndex(i, i));
          return std::max(
              {1.0, std::abs(plain.gradient[at(i)]), std::sqrt(std::abs(plain.hessian[diagonal]))});
        };
        double error = 0;
        for (int i = 0; i < n; ++i) {
          const auto g = at(i);
          error = std::max(error, std::abs(local.gradient[g] - plain.gradient[g]) / scale(i));
          for (int j = 0; j <= i; ++j) {
            const auto h = at(ad::triangleIndex(i, j));
            error = std::max(error,
                             std::abs(local.hessian[h] - plain.hessian[h]) / (scale(i) * scale(j)));
          }
        }
        EXPECT_LE(error, 1e-6) << pathText(path.technique, path.sample);
        worst = std::max(worst, error);
      });
  std::printf("%s: %d paths, worst difference %.1e\n", GetParam().name, checked, worst);
  EXPECT_GT(checked, 50);
}

TEST_P(PathDerivative, SlowAgreesWithFiniteDifferences) {
  GradcheckSettings settings;
  settings.maxLength = GetParam().maxLength;
  long long agree = 0, unjudged = 0;
  const std::span<const DerivativeForm> forms = derivativeForms();
  std::array<int, kMostForms> supported{}, rounding{}, wrong{};
  const std::vector<SampledPath> paths =
      sampleBidirectional(*scene_, settings.maxLength, kPaths, 5);
  ASSERT_EQ(static_cast<int>(paths.size()), kPaths);
  for (const SampledPath& sampled : paths) {
    const PathCheck check = checkPath(*scene_, sampled, settings);
    const std::string text = pathText(sampled.technique, sampled.sample);
    EXPECT_TRUE(check.traced && check.finite) << text;
    EXPECT_EQ(check.wrong, 0) << text;
    agree += check.agree;
    unjudged += check.noisy + check.kinked;
    for (std::size_t k = 0; k < forms.size(); ++k) {
      const FormCheck& form = check.forms[k];
      supported[k] += form.verdict != FormVerdict::kUnsupported;
      rounding[k] += form.verdict == FormVerdict::kRounding;
      if (form.verdict != FormVerdict::kWrong && form.verdict != FormVerdict::kNotFinite) continue;
      ++wrong[k];
      std::printf("  %s, float: value %.1e, gradient %.1e, Hessian %.1e off: %s\n", forms[k].name,
                  form.value, form.gradient, form.hessian, text.c_str());
    }
  }
  std::printf("%s: %lld entries agree, %lld not judged\n", GetParam().name, agree, unjudged);
  EXPECT_GT(agree, 8 * unjudged);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    std::printf("  %s, float: of %d paths %d rounding, %d wrong\n", forms[k].name, supported[k],
                rounding[k], wrong[k]);
    EXPECT_GT(supported[k], kPaths / 4);
    // Where float takes the other side of a kink, all of its neighbours may.
    EXPECT_LE(wrong[k], kPaths / 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathDerivative, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc
