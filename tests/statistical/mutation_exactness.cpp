// SPDX-License-Identifier: MIT
// Every mutation in the list, alone, and every method's whole mixture: chains that start exactly from the target keep
// it, on scenes that between them have all that a mutation can meet; and what they splat has the image as its mean. A
// new mutation or method is tested by standing in its list. The last test is of the test: mistakes that are planted in
// each mutation are seen.
#include <gtest/gtest.h>

#include <memory>

#include "exactness_world.h"
#include "image_check.h"
#include "mcmc/methods/methods.h"
#include "toy_kernels.h"

namespace h2mc::test {
namespace {

using Case = std::tuple<Kernel, ExactnessScene>;
std::string caseName(const ::testing::TestParamInfo<Case>& info) {
  return std::get<0>(info.param).name + "_" + std::get<1>(info.param).name;
}

class MutationAlone : public ::testing::TestWithParam<Case> {};

TEST_P(MutationAlone, KeepsTheTargetSlow) {
  const auto& [kernel, scene] = GetParam();
  const World world(scene);
  SlotNumbers slots;
  KernelMixture kernels = world.alone(kernel, slots);
  ExactnessPlan plan;
  plan.learnAfter = plan.samples / 10;
  const ExactnessReport report = reportOn(world.target, kernels, plan);
  EXPECT_TRUE(report.passed) << report.text;
  EXPECT_GT(report.acceptance, 0.02);
}

// Where a kernel says its density, its ratio is that of the two ways' densities.
TEST_P(MutationAlone, HasTheRatioOfItsDensities) {
  const auto& [kernel, scene] = GetParam();
  if (kernel.large) GTEST_SKIP() << "large steps have one density each: no ratio to compare";
  const World world(scene);
  SlotNumbers slots;
  KernelMixture kernels = world.alone(kernel, slots);
  Mutation& mutation = kernels.mutation(1);
  ExactStarts starts(world.target, 1, 7);
  ChainState from(world.maxLength), to(world.maxLength);
  Random random(7, 1, 0);
  MutationContext context;
  context.random = &random;
  int made = 0, compared = 0;
  for (int i = 0; i < 4000; ++i) {
    from.forget();
    to.forget();
    if (!(starts.start(i, from.path) > 0) || !mutation.applies(from.path)) continue;
    const Proposal proposal = mutation.propose(from, to, context);
    if (!proposal.made()) continue;
    ++made;
    const auto there = mutation.logDensity(from, to, context);
    if (!there) GTEST_SKIP() << "has no density of its own";
    const auto back = mutation.logDensity(to, from, context);
    EXPECT_NEAR(proposal.logRatio(), *back - *there, 1e-4 * (1 + std::abs(*there)));
    ++compared;
  }
  if (made == 0) GTEST_SKIP() << "hardly a path of this scene suits it";
  EXPECT_GT(compared, 50);
}

INSTANTIATE_TEST_SUITE_P(Kernels, MutationAlone,
                         ::testing::Combine(::testing::ValuesIn(allKernels()),
                                            ::testing::ValuesIn(exactnessScenes())),
                         caseName);

// A method's mixture, with shares that leap from each octave to the next, large steps that count as samples, and what
// kernels keep of a state used by one after the other.
class MethodMixture
    : public ::testing::TestWithParam<std::tuple<std::string, std::string, ExactnessScene>> {};

TEST_P(MethodMixture, KeepsTheTargetSlow) {
  const auto& [name, large, scene] = GetParam();
  const World world(scene);
  const MetropolisMethod& method = methodNamed(name);
  OptionSet options(method.plugin());
  options.set("largeStep", large);
  KernelMixture kernels = makeKernels(method, world.target, world.techniques, options, 1);
  kernels.meanTarget = ExactStarts(world.target, 1, 5).meanTarget();
  // As if there were others beside them: what samples take of each path is more.
  if (large == "bidirectional") {
    kernels.baseSamples = 0.2;
    kernels.dividesByHolding = true;
  }
  learnLeaps(kernels);
  const ExactnessReport report = reportOn(world.target, kernels);
  EXPECT_TRUE(report.passed) << report.text;
}

std::vector<std::string> names(auto list) {
  std::vector<std::string> result;
  for (const auto& entry : list) result.emplace_back(entry.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(Methods, MethodMixture,
                         ::testing::Combine(::testing::ValuesIn(names(metropolisMethods())),
                                            ::testing::ValuesIn(names(largeSteps())),
                                            ::testing::ValuesIn(exactnessScenes())),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<1>(info.param) + "_" +
                                  std::get<2>(info.param).name;
                         });

// Another target, made of that one by a power: kernels ask nothing else of a target than its value and its derivatives.
class Tempered final : public PathTarget {
 public:
  Tempered(const PathTarget& target, double power)
      : PathTarget(target.scene(), target.maxLength()), target_(target), power_(power) {}
  double value(const Technique& technique, const Rgbf& contribution, float filmX,
               float filmY) const override {
    const double value = target_.value(technique, contribution, filmX, filmY);
    return value > 0 ? std::pow(value, power_) : 0;
  }
  void differentiate(const Path& path, Derivative& result) const override {
    target_.differentiate(path, result);
    const int n = result.dimension;
    for (int i = 0; i < n; ++i) result.gradient[i] *= static_cast<float>(power_);
    for (int i = 0; i < n * (n + 1) / 2; ++i) result.hessian[i] *= static_cast<float>(power_);
  }
  void differentiateOnce(const Path& path, Gradient& result) const override {
    target_.differentiateOnce(path, result);
    for (int i = 0; i < result.dimension; ++i) result.gradient[i] *= static_cast<float>(power_);
  }

 private:
  const PathTarget& target_;
  double power_;
};

TEST(TemperedTarget, IsKeptByTheSameKernelsSlow) {
  const World world(exactnessScenes()[0]);
  const Tempered target(world.target, 0.6);
  for (const MetropolisMethod& method : metropolisMethods()) {
    KernelMixture kernels =
        makeKernels(method, target, world.techniques, OptionSet(method.plugin()), 1);
    kernels.meanTarget = ExactStarts(target, 1, 5).meanTarget();
    std::printf("%s, ", std::string(method.name).c_str());
    const ExactnessReport report = reportOn(target, kernels);
    EXPECT_TRUE(report.passed) << method.name << "\n" << report.text;
  }
}

enum class Mistake { kFactor, kNoJacobian, kNoReverseCheck };

// A mutation with a mistake in it.
class Mistaken final : public Mutation {
 public:
  Mistaken(std::unique_ptr<Mutation> inner, Mistake mistake)
      : inner_(std::move(inner)), mistake_(mistake) {}
  std::string_view name() const override { return inner_->name(); }
  bool applies(const Path& path) const override { return inner_->applies(path); }
  void splatProposal(const ChainState& proposed, double weight, const Division& division,
                     StateFilm& film) const override {
    inner_->splatProposal(proposed, weight, division, film);
  }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override {
    // Steps that can't be taken back are taken: only every second half octave of the target is ever left.
    if (mistake_ == Mistake::kNoReverseCheck &&
        static_cast<int>(std::floor(2 * std::log2(current.path.target))) % 2 != 0)
      return Proposal::none();
    const Proposal proposal = inner_->propose(current, proposed, context);
    if (!proposal.made()) return proposal;
    hadRatio_ |= !proposal.isDecided() && proposal.logRatio() != 0;
    switch (mistake_) {
      case Mistake::kFactor:
        // What is brighter is proposed less often by 1.1 than the ratio says.
        return proposed.path.target > current.path.target && context.random->uniform() > 1 / 1.1
                   ? Proposal::none()
                   : proposal;
      case Mistake::kNoJacobian:
        return proposal.isDecided() ? proposal : Proposal::withLogRatio(0);
      case Mistake::kNoReverseCheck:
        break;
    }
    return proposal;
  }
  bool hadRatio() const { return hadRatio_; }

 private:
  std::unique_ptr<Mutation> inner_;
  Mistake mistake_;
  bool hadRatio_ = false;
};

class PlantedMistake : public ::testing::TestWithParam<Kernel> {};

// The kernel alone, with the mistake; whether it has one is left in `harmless`.
ExactnessReport reportOn(const World& world, const Kernel& kernel, Mistake mistake, int samples,
                         bool& harmless) {
  SlotNumbers slots;
  KernelMixture kernels = world.alone(kernel, slots);
  std::unique_ptr<Mutation> inner;
  if (kernel.large)
    inner = std::move(kernels.large);
  else
    inner = std::move(kernels.small[0].mutation);
  auto mistaken = std::make_unique<Mistaken>(std::move(inner), mistake);
  const Mistaken& watched = *mistaken;
  kernels = world.alone(std::move(mistaken));
  ExactnessPlan plan;
  plan.samples = samples;
  if (kernel.large) plan.steps = 60;  // few are accepted
  const ExactnessReport report = reportOn(world.target, kernels, plan);
  // Where there is no ratio, leaving it out is no mistake.
  harmless = mistake == Mistake::kNoJacobian && !watched.hadRatio();
  return report;
}

// The share of the scene's paths that suit the mutation.
double suited(const World& world, const Kernel& kernel) {
  if (kernel.large) return 1;
  SlotNumbers slots;
  const KernelMixture kernels = world.alone(kernel, slots);
  ExactStarts starts(world.target, 1, 7);
  Path path(world.maxLength);
  double all = 0, suitable = 0;
  for (int i = 0; i < 5000; ++i) {
    const double weight = starts.start(i, path);
    if (!(weight > 0)) continue;
    all += weight;
    if (kernels.small[0].mutation->applies(path)) suitable += weight;
  }
  return suitable / all;
}

// Mistakes are soon seen where many paths suit the mutation: in the first scene of which a fifth do, else in the one of
// which most do.
ExactnessScene sceneFor(const Kernel& kernel) {
  const std::vector<ExactnessScene> scenes = exactnessScenes();
  std::size_t best = 0;
  double most = 0;
  for (std::size_t i = 0; i < scenes.size() && most < 0.2; ++i) {
    const double share = suited(World(scenes[i]), kernel);
    if (share <= most) continue;
    best = i;
    most = share;
  }
  return scenes[best];
}

TEST_P(PlantedMistake, IsSeenSlow) {
  const World world(sceneFor(GetParam()));
  for (const Mistake mistake : {Mistake::kFactor, Mistake::kNoJacobian, Mistake::kNoReverseCheck}) {
    bool harmless = false;
    ExactnessReport report = reportOn(world, GetParam(), mistake, 300000, harmless);
    // Large steps and changes of technique, which often lead nowhere, need more.
    if (report.passed && !harmless)
      report = reportOn(world, GetParam(), mistake, 2000000, harmless);
    // What few paths suit, such as a perturbation for several smooth stretches, needs more still.
    if (report.passed && !harmless)
      report = reportOn(world, GetParam(), mistake, 5000000, harmless);
    std::printf("mistake %d: smallest p %.2g\n", static_cast<int>(mistake), report.smallestP);
    EXPECT_EQ(report.passed, harmless) << "mistake " << static_cast<int>(mistake) << "\n"
                                       << report.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, PlantedMistake, ::testing::ValuesIn(allKernels()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace h2mc::test
