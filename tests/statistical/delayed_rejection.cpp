// SPDX-License-Identifier: MIT
// Second tries, chosen with a probability that leaps from state to state, and mistakes that only they can have.
#include "mcmc/mutations/delayed_rejection.h"

#include <gtest/gtest.h>

#include "chi_square.h"
#include "exactness_world.h"
#include "mcmc/mutations/hamiltonian_step.h"
#include "render/core/unit_interval.h"
#include "toy_kernels.h"

namespace h2mc::test {
namespace {

// Bold first tries, which are often refused.
constexpr float kFirst = 0.05f, kSecond = 0.01f;

// First and second try weigh with which probability their states choose the kernel.
TEST(DelayedRejection, KeepsTheTargetWhateverSharesAreLearnedSlow) {
  for (const ExactnessScene& scene : exactnessScenes()) {
    const World world(scene);
    SlotNumbers slots;
    HamiltonianSettings settings;
    KernelMixture kernels = world.alone(std::make_unique<DelayedRejection>(
        world.target, "delayed", kFirst,
        std::make_unique<HamiltonianStep>(world.target, settings, slots)));
    kernels.small.push_back(
        {std::make_unique<IsotropicStep>(world.target, StepShape::kGaussian, kSecond), 1, {}});
    for (KernelMixture::Small& s : kernels.small) s = {std::move(s.mutation), 0.5, 1};
    kernels.meanTarget = ExactStarts(world.target, 1, 5).meanTarget();
    kernels.largeProbability = 0.1;
    learnLeaps(kernels);
    const ExactnessReport report = reportOn(world.target, kernels);
    EXPECT_TRUE(report.passed) << scene.name << "\n" << report.text;
  }
}

// Forgets that on the way back the first try has to be refused.
struct NeverRefusedBack final : DelayedRejection {
  using DelayedRejection::DelayedRejection;
  Proposal proposeAgain(ChainState& current, const ChainState& refused, ChainState& proposed,
                        ChainState& back, MutationContext& context) override {
    const Proposal proposal =
        DelayedRejection::proposeAgain(current, refused, proposed, back, context);
    back.path.target = 0;
    return proposal;
  }
};
// Accepts as if there had been no first try, neither here nor there.
struct AsIfAlone final : DelayedRejection {
  using DelayedRejection::DelayedRejection;
  Proposal proposeAgain(ChainState& current, const ChainState& refused, ChainState& proposed,
                        ChainState& back, MutationContext& context) override {
    const Proposal proposal =
        DelayedRejection::proposeAgain(current, refused, proposed, back, context);
    back.path = proposed.path;
    back.path.target *= refused.path.target / current.path.target;
    return proposal;
  }
};
// Takes the first try itself.
struct TheSameTry final : DelayedRejection {
  using DelayedRejection::DelayedRejection;
  float back(float, float y, float) const override { return y; }
};
// Is reflected where it has to wrap.
struct Reflected final : DelayedRejection {
  using DelayedRejection::DelayedRejection;
  float back(float x, float y, float z) const override { return reflect(z - (y - x)); }
};

// On two coordinates: falls from one border of the one to the other, where it leaps back, and fades along the other.
class Slope final : public Target {
 public:
  int maxLength() const override { return 1; }
  static float f(float u0, float u1) { return std::exp(-u0 / 0.1f) * (1.1f - u1) + 0.02f; }
  bool evaluate(Path& path) const override {
    path.wraps = 3;
    path.target = f(path.sample.u[0], path.sample.u[1]);
    return true;
  }
  void differentiate(const Path&, Derivative&) const override {}
  void differentiateOnce(const Path&, Gradient&) const override {}
};

constexpr int kCells = 12;
std::size_t cellOf(float u0, float u1) {
  const auto cell = [](float u) { return at(u * kCells); };
  return cell(u0) * kCells + cell(u1);
}

// Chains from exact starts.
template <class Step>
ChiSquareVerdict onSlope() {
  const Slope target;
  const Technique technique{0, 2};
  std::vector<double> expected(kCells * kCells, 0), seen = expected;
  constexpr int kFine = 600, kChains = 200000, kSteps = 10;
  double sum = 0;
  for (int i = 0; i < kFine; ++i)
    for (int j = 0; j < kFine; ++j) {
      const float u0 = (static_cast<float>(i) + 0.5f) / kFine;
      const float u1 = (static_cast<float>(j) + 0.5f) / kFine;
      expected[cellOf(u0, u1)] += Slope::f(u0, u1);
      sum += Slope::f(u0, u1);
    }
  for (double& e : expected) e *= kChains / sum;

  const TechniqueDistribution techniques = evenly(std::span(&technique, 1));
  KernelMixture kernels;
  kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
  kernels.largeProbability = 0;
  kernels.small.push_back(
      {std::make_unique<Step>(target, "delayed", 0.1f,
                              std::make_unique<IsotropicStep>(target, StepShape::kGaussian, 0.3f)),
       1,
       {}});
  ChainFilms films;
  ChainStatistics statistics(kernels.kinds(), 1);
  MutationContext context;
  Random random(5, 0, 0);
  Path start(1);
  start.technique = technique;
  for (int c = 0; c < kChains; ++c) {
    do {
      for (int i = 0; i < 2; ++i) start.sample.u[at(i)] = random.uniform();
      target.evaluate(start);
    } while (start.target < 1.15f * random.uniform());
    Chain chain(target, start, Random(6, static_cast<std::uint64_t>(c), 0));
    for (int i = 0; i < kSteps; ++i) chain.step(kernels, films, statistics, context);
    films.clear();
    seen[cellOf(chain.path().sample.u[0], chain.path().sample.u[1])] += 1;
  }
  const ChiSquareVerdict verdict = chiSquareTest(seen, expected, 6);
  const AcceptanceCount& second = statistics.secondTries[1];
  std::printf("second tries %lld, accepted %.0f; p %.2g\n", second.proposed, second.expected,
              verdict.pValue);
  EXPECT_GT(second.expected, 0.03 * static_cast<double>(second.proposed));
  return verdict;
}

TEST(DelayedRejection, MistakesAreSeenSlow) {
  const ChiSquareVerdict right = onSlope<DelayedRejection>();
  EXPECT_TRUE(right.passed) << right.message;
  EXPECT_FALSE(onSlope<NeverRefusedBack>().passed);
  EXPECT_FALSE(onSlope<AsIfAlone>().passed);
  EXPECT_FALSE(onSlope<TheSameTry>().passed);
  EXPECT_FALSE(onSlope<Reflected>().passed);
}

}  // namespace
}  // namespace h2mc::test
