// SPDX-License-Identifier: MIT
// The lists of methods, their mutations and presets.
#include "mcmc/methods/methods.h"

#include <gtest/gtest.h>

#include <set>

#include "mcmc/methods/presets.h"
#include "mcmc/mutations/mutations.h"
#include "mcmc/render/integrator_choice.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

TEST(Methods, SharesAddUpAndEveryOptionIsThereOnce) {
  for (const MetropolisMethod& method : metropolisMethods()) {
    const OptionSet options(method.plugin());
    double sum = 0;
    for (const MetropolisMethod::Step& step : method.steps(options)) {
      sum += step.share;
      for (const Parameter& p : mutationNamed(step.mutation).parameters)
        EXPECT_TRUE(options.has(p.name)) << method.name << " " << p.name;
    }
    EXPECT_NEAR(sum, 1, 1e-12) << method.name;
    std::set<std::string_view> names;
    for (const Parameter& p : method.parameters)
      EXPECT_TRUE(names.insert(p.name).second) << method.name << " " << p.name;
    EXPECT_NO_THROW(checkOptions(method, options));
  }
}

TEST(Methods, AnOptionBelongsToTheMethodsThatHaveItsMutation) {
  EXPECT_FALSE(OptionSet(methodNamed("mmlt").plugin()).has("trajectoryLength"));
  EXPECT_TRUE(OptionSet(methodNamed("h2mc").plugin()).has("trajectoryLength"));
  OptionSet options(methodNamed("mmlt").plugin());
  options.set("sigma", "0");
  EXPECT_THROW(checkOptions(methodNamed("mmlt"), options), OptionError);
}

// What would change nothing is refused.
TEST(Methods, OptionsThatDoNotGoTogether) {
  const Scene scene = SceneFolder().read(sceneWith(""));
  for (const char* wish :
       {"remlt:replicas=0", "remlt:leastPower=0", "h2mc:replicas=2",
        "h2mc:delayedRejection=true,isotropicProbability=0.2",
        "h2mc:divisionByHolding=true,baseSamples=0", "mmlt-2014:divisionByHolding=true"})
    EXPECT_THROW(chooseIntegrator(wish, scene), OptionError) << wish;
  for (const char* wish : {"h2mc:delayedRejection=true", "mmlt:divisionByHolding=true"})
    EXPECT_NO_THROW(chooseIntegrator(wish, scene)) << wish;
}

TEST(TourMethods, RefuseWhatMeansNothing) {
  const Scene scene = SceneFolder().read(sceneWith(""));
  for (const char* wish :
       {"erpt:numChains=0", "erpt:chainLength=0", "erpt:luminanceSamples=0", "restore:tourLength=0",
        "restore:targetLimit=-1", "restore:lensShare=2", "erpt:tourLength=3", "restore:sigma=0",
        "erpt:lensShare=0,isotropicShare=0,hamiltonianShare=0"})
    EXPECT_THROW(chooseIntegrator(wish, scene), OptionError) << wish;
  for (const char* wish : {"erpt:causticShare=1", "restore", "erpt-2005"})
    EXPECT_NO_THROW(chooseIntegrator(wish, scene)) << wish;
}

TEST(Presets, SetWhatTheySayAndTheCommandLineGoesBefore) {
  const Scene scene = SceneFolder().read(
      sceneWith("<integrator type=\"mmlt\"><integer name=\"maxDepth\" value=\"7\"/></integrator>"));
  for (const Preset& preset : presets()) {
    const OptionSet options =
        chooseIntegrator(std::string(preset.name) + ":minDepth=3", scene).options;
    EXPECT_EQ(options.integrator(), preset.method);
    EXPECT_EQ(options.integer("minDepth"), 3);
    EXPECT_EQ(options.integer("maxDepth"), 7);
    for (const auto& [name, value] : preset.options) {
      OptionSet only = chooseIntegrator(std::string(preset.method), scene).options;
      only.set(name, std::string(value));
      EXPECT_EQ(options.values().find(name)->second, only.values().find(name)->second) << name;
    }
  }
  EXPECT_THROW(checkIntegratorWish("mmlt-2014:largeSteps=3"), OptionError);
  EXPECT_THROW(checkIntegratorWish("mmlt-2013"), OptionError);
}

}  // namespace
}  // namespace h2mc::testing
