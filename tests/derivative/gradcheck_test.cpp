// SPDX-License-Identifier: MIT
// gradcheck itself: it finds what is broken, in the right place, and nothing else.
#include "check/gradcheck/gradcheck.h"

#include <gtest/gtest.h>

#include <set>

#include "check/gradcheck/report.h"
#include "mcmc/render/integrators.h"
#include "render/path/path_text.h"
#include "render/path/replay_double.h"
#include "render/scene/kinds.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

const Scene& ring() {
  static const Scene scene = [] {
    std::vector<IntegratorPlugin> plugins;
    for (const IntegratorFactory& f : allIntegrators()) plugins.push_back(f.plugin);
    ReadOptions options;
    options.integrators = plugins;
    return readScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", options);
  }();
  return scene;
}

GradcheckSettings settings() {
  GradcheckSettings s;
  s.paths = 120;
  s.maxLength = 5;
  s.seed = 11;
  s.threads = 2;
  return s;
}

bool has(const PathTraits& traits, const char* bsdf) {
  for (std::size_t k = 0; k < bsdfKinds().size(); ++k)
    if (std::string(bsdfKinds()[k]) == bsdf) return (traits.bsdfs >> k) & 1;
  return false;
}

TEST(Gradcheck, NothingIsWrongInDouble) {
  const GradcheckResult result = gradcheck(ring(), settings());
  ASSERT_EQ(result.paths.size(), 120u);
  std::set<std::pair<int, int>> techniques;
  long long judged = 0, entries = 0;
  int chains = 0;
  for (const PathCheck& p : result.paths) {
    EXPECT_TRUE(p.traced);
    EXPECT_TRUE(p.finite);
    EXPECT_EQ(p.wrong, 0) << pathText(p.path.technique, p.path.sample);
    judged += p.agree;
    entries += p.agree + p.noisy + p.kinked;
    chains += p.path.origin == PathOrigin::kChain;
    techniques.insert({p.path.technique.s, p.path.technique.t});
  }
  EXPECT_GT(judged, 0.9 * static_cast<double>(entries));
  EXPECT_EQ(chains, 60);
  EXPECT_GT(techniques.size(), 10u);
}

// One sign in one BSDF: of the derivative by a coordinate that this BSDF alone has to do with.
TEST(Gradcheck, FindsOneWrongSign) {
  GradcheckSettings s = settings();
  s.forms = {};
  s.exact = [](const Scene& scene, const Path& path, const double* u) {
    ad::DerivativeValues d = differentiateInDouble(scene, path, u);
    if (has(traitsOf(scene, path), "roughconductor")) d.hessian[1] = -d.hessian[1];
    return d;
  };
  const GradcheckResult result = gradcheck(ring(), s);
  long long touched = 0;
  for (const PathCheck& p : result.paths) {
    if (has(p.traits, "roughconductor")) ++touched;
    EXPECT_TRUE(!p.failed() || has(p.traits, "roughconductor"));
  }
  EXPECT_GT(touched, 20);
  EXPECT_GT(result.failures(), touched * 3 / 4);

  // The report names what fails, where it fails, and how to see it again.
  const nlohmann::json report = gradcheckReport(ring(), s, result);
  EXPECT_EQ(report["pathsOutOfTolerance"], result.failures());
  for (const auto& row : report["groups"][1]["rows"]) {
    if (row["name"] != "roughconductor") continue;
    EXPECT_EQ(row["outOfTolerance"], result.failures());
  }
  ASSERT_FALSE(report["worst"].empty());
  EXPECT_EQ(report["worst"][0]["verdict"], "out of tolerance");
  SampledPath replayed;
  ASSERT_EQ(parsePathText(report["worst"][0]["replay"], replayed.technique, replayed.sample), "");
  const PathCheck again = checkPath(ring(), replayed, s);
  EXPECT_TRUE(again.failed());
  EXPECT_EQ(again.hessianError, report["worst"][0]["hessianError"].get<double>());
}

bool wrongForm(const Scene& scene, const Path& path, ad::DerivativeValues& result) {
  if (!derivativeForms()[0].differentiate(scene, path, result)) return false;
  for (double& h : result.hessian) h *= 1.01;
  return true;
}
bool brokenForm(const Scene& scene, const Path& path, ad::DerivativeValues& result) {
  if (!derivativeForms()[0].differentiate(scene, path, result)) return false;
  result.gradient[0] = NAN;
  return true;
}
bool shortForm(const Scene&, const Path&, ad::DerivativeValues&) { return false; }

TEST(Gradcheck, JudgesFloatForms) {
  const DerivativeForm forms[] = {derivativeForms()[0],
                                  {"wrong", "", wrongForm},
                                  {"broken", "", brokenForm},
                                  {"short", "", shortForm}};
  GradcheckSettings s = settings();
  s.forms = forms;
  s.maxLength = 3;
  int wrong = 0, right = 0;
  for (const PathCheck& p : gradcheck(ring(), s).paths) {
    right += p.forms[0].verdict == FormVerdict::kAgrees;
    wrong += p.forms[1].verdict == FormVerdict::kWrong;
    EXPECT_EQ(p.forms[2].verdict, FormVerdict::kNotFinite);
    EXPECT_EQ(p.forms[3].verdict, FormVerdict::kUnsupported);
  }
  EXPECT_GT(right, 108);
  EXPECT_GT(wrong, 108);
}

TEST(Gradcheck, SamePathsForAnyNumberOfThreads) {
  GradcheckSettings s = settings();
  s.paths = 60;
  const GradcheckResult two = gradcheck(ring(), s);
  s.threads = 1;
  const GradcheckResult one = gradcheck(ring(), s);
  ASSERT_EQ(one.paths.size(), two.paths.size());
  for (std::size_t i = 0; i < one.paths.size(); ++i) {
    const auto& [a, b] = std::pair(one.paths[i], two.paths[i]);
    EXPECT_EQ(pathText(a.path.technique, a.path.sample), pathText(b.path.technique, b.path.sample));
    EXPECT_EQ(a.hessianError, b.hessianError);
  }
}

}  // namespace
}  // namespace h2mc
