// SPDX-License-Identifier: MIT
// Steps of whole bidirectional samples: chains long enough to forget, and mistakes that only these steps can have.
#include <gtest/gtest.h>

#include "exactness_world.h"
#include "mcmc/methods/methods.h"
#include "mcmc/mutations/whole_sample_steps.h"
#include "render/core/unit_interval.h"

namespace h2mc::test {
namespace {

// What a chain has derived from its state it forgets now and then: here twice.
TEST(WholeSample, IsDrawnAnewAroundThePathSlow) {
  for (const ExactnessScene& scene : exactnessScenes()) {
    const World world(scene);
    const MetropolisMethod& method = methodNamed("pssmlt");
    KernelMixture kernels =
        makeKernels(method, world.target, world.techniques, OptionSet(method.plugin()), 1);
    ExactnessPlan plan;
    plan.samples = 10000;
    plan.steps = 2 * Chain::kDerivedAnew + 20;
    const ExactnessReport report = reportOn(world.target, kernels, plan);
    EXPECT_TRUE(report.passed) << scene.name << "\n" << report.text;
  }
}

// Coordinates go on and never back.
struct OneWay final : WholeSampleStep {
  using WholeSampleStep::WholeSampleStep;
  float moved(int place, float value, Random& random) const override {
    const float to = WholeSampleStep::moved(place, value, random);
    return to > value ? to : wrap(2 * value - to);
  }
};
// Those that would leave the cube stop at its border.
struct Clamped final : WholeSampleStep {
  using WholeSampleStep::WholeSampleStep;
  float moved(int, float value, Random& random) const override {
    return std::clamp(value + 0.2f * random.normal(), 0.f, kBelowOne);
  }
};

template <class Step>
bool isSeen() {
  const World world(exactnessScenes()[0]);
  SlotNumbers slots;
  const OptionSet options;
  const MutationSetup setup{world.target, world.techniques, 1, options, slots};
  KernelMixture kernels = world.alone(std::make_unique<Step>(setup, WholeSampleStep::Settings{}));
  ExactnessPlan plan;
  for (const int samples : {300000, 2000000}) {
    plan.samples = samples;
    if (!reportOn(world.target, kernels, plan).passed) return true;
  }
  return false;
}

TEST(WholeSample, MistakesAreSeenSlow) {
  EXPECT_TRUE(isSeen<OneWay>());
  EXPECT_TRUE(isSeen<Clamped>());
}

}  // namespace
}  // namespace h2mc::test
