// SPDX-License-Identifier: MIT
// Tours: whatever the rule by which chains begin and end, and whatever the kernel that keeps the target, what they
// splat has the image as its mean, and its errors are what they are said to be. Mistakes that are planted are seen.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "exactness_world.h"
#include "mcmc/tours/tour_group.h"
#include "mcmc/tours/tour_method.h"
#include "tiny_render.h"

namespace h2mc::test {
namespace {

constexpr int kBatches = 12000;

// Blocks of the film by bidirectional samples.
BlockMoments byBdpt(const World& world, int samples) {
  BidirectionalSampler sampler(world.maxLength);
  BlockMoments blocks;
  SplatList splats;
  constexpr int kAtOnce = 64;
  for (int i = 0; i < samples / kAtOnce; ++i) {
    Random random(77, 1, static_cast<std::uint64_t>(i));
    splats.clear();
    for (int k = 0; k < kAtOnce; ++k)
      sampler.sample(world.scene, random, -1, -1, 1,
                     [&](const auto& c) { splats.splat(c.filmX, c.filmY, c.contribution); });
    blocks.add(splats, 1.0 / kAtOnce);
  }
  return blocks;
}

double meanTarget(const World& world) { return ExactStarts(world.target, 1, 5).meanTarget(); }

BlockMoments byTours(const World& world, const TourRule& rule, KernelMixture kernels, int batches,
                     TourCounts* counts = nullptr) {
  TourGroup group(world.target, rule, std::move(kernels), 1, 3, false);
  for (int i = 0; i < batches; ++i) {
    group.run(i);
    group.films().clear();
  }
  if (counts) *counts = group.counts();
  BlockMoments blocks;
  blocks.add(group.blocks());
  return blocks;
}

// `part`: about what a tour hands on. A block that is so dark that few tours come there has an error that these few
// can't tell: that of their number, if each brings this much.
ExactnessReport compare(const BlockMoments& tours, const BlockMoments& reference, double part) {
  ExactnessReport report;
  const auto add = [&](const std::string& what, const Moments& a, const Moments& b, double most) {
    const double ofNumber = b.mean() * most / static_cast<double>(a.count);
    const double variance =
        std::max(squared(a.standardError()), ofNumber) + squared(b.standardError());
    if (!(variance > 0)) return;
    const double z = (a.mean() - b.mean()) / std::sqrt(variance);
    report.add(what, std::erfc(std::abs(z) / std::sqrt(2.0)),
               std::to_string(a.mean()) + " +- " + std::to_string(a.standardError()) + ", not " +
                   std::to_string(b.mean()) + " +- " + std::to_string(b.standardError()),
               kVerdicts);
  };
  const double ofFilm = part / TourGroup::kBatch;
  add("film", tours.whole(), reference.whole(), ofFilm);
  for (int y = 0; y < BlockMoments::kRows; ++y)
    for (int x = 0; x < BlockMoments::kColumns; ++x)
      add("block " + std::to_string(x) + "," + std::to_string(y), tours.block(x, y),
          reference.block(x, y), ofFilm * BlockMoments::kColumns * BlockMoments::kRows);
  std::printf("tours %.5f +- %.5f, bdpt %.5f +- %.5f, smallest p %.2g\n", tours.whole().mean(),
              tours.whole().standardError(), reference.whole().mean(),
              reference.whole().standardError(), report.smallestP);
  return report;
}

OptionSet options(const TourMethod& method,
                  const std::vector<std::pair<std::string, std::string>>& values) {
  OptionSet set(method.plugin());
  for (const auto& [name, value] : values)
    if (set.has(name)) set.set(name, value);
  return set;
}

const std::vector<std::pair<std::string, std::string>> kShort{{"chainLength", "12"},
                                                              {"tourLength", "12"}};
// All mutations at once.
const std::vector<std::pair<std::string, std::string>> kAll{
    {"langevinShare", "0.3"},   {"veachLensShare", "0.2"},   {"causticShare", "0.2"},
    {"multiChainShare", "0.2"}, {"lensSubpathShare", "0.2"}, {"bidirectionalShare", "0.2"},
    {"techniqueShare", "0.1"}};

class Tours : public ::testing::TestWithParam<std::tuple<std::string, ExactnessScene>> {
 protected:
  static const TourMethod& method(const std::string& name) {
    for (const TourMethod& m : tourMethods())
      if (m.name == name) return m;
    throw std::runtime_error(name);
  }
};

// With all mutations, at lengths of a few states and of one, shares learned on the way.
TEST_P(Tours, HaveTheImageAsTheirMeanSlow) {
  const auto& [name, scene] = GetParam();
  const World world(scene);
  const double mean = meanTarget(world);
  const BlockMoments reference = byBdpt(world, 400000);
  std::vector<std::pair<std::string, std::string>> wishes[2] = {kShort, kAll};
  wishes[1].insert(wishes[1].end(), {{"chainLength", "1"}, {"tourLength", "3"}});
  for (const auto& wish : wishes) {
    const OptionSet set = options(method(name), wish);
    const auto rule = method(name).rule(set, mean);
    TourCounts counts;
    const BlockMoments tours =
        byTours(world, *rule, makeTourKernels(world.target, set, 1, mean), kBatches, &counts);
    const ExactnessReport report = compare(tours, reference, mean);
    EXPECT_TRUE(report.passed) << report.text;
    const double wanted = method(name).mutationsASample(set);
    EXPECT_NEAR(static_cast<double>(counts.mutations) / static_cast<double>(counts.samples), wanted,
                0.1 * wanted);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Tours,
                         ::testing::Combine(::testing::Values("erpt", "restore"),
                                            ::testing::ValuesIn(exactnessScenes())),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::get<1>(info.param).name;
                         });

// A step that leaves its half of the film never, and so reaches but half of all paths. It keeps the target, and that is
// all that tours need.
class HalfStep final : public Mutation {
 public:
  explicit HalfStep(std::unique_ptr<Mutation> inner) : inner_(std::move(inner)) {}
  std::string_view name() const override { return "half"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override {
    const Proposal proposal = inner_->propose(current, proposed, context);
    return (current.path.filmX < 0.5f) == (proposed.path.filmX < 0.5f) ? proposal
                                                                       : Proposal::none();
  }

 private:
  std::unique_ptr<Mutation> inner_;
};

KernelMixture isotropicAlone(const World& world, bool half) {
  SlotNumbers slots;
  const MutationPlugin& plugin = mutationNamed("isotropic");
  const OptionSet set = optionsOf(plugin, {"isotropic", "isotropic", {}});
  auto step = plugin.create(MutationSetup{world.target, world.techniques, 1, set, slots});
  if (half) step = std::make_unique<HalfStep>(std::move(step));
  return world.alone(std::move(step));
}

TEST(TourRules, NeedNoErgodicKernelSlow) {
  const World world(exactnessScenes()[0]);
  const double mean = meanTarget(world);
  const BlockMoments reference = byBdpt(world, 400000);
  for (const auto& rule : {energyRedistribution(mean, 1, 100), energyRedistribution(mean, 3, 2),
                           regeneration(mean, 30), regeneration(mean, 1)}) {
    const ExactnessReport report =
        compare(byTours(world, *rule, isotropicAlone(world, true), kBatches), reference, mean);
    EXPECT_TRUE(report.passed) << report.text;
  }
}

// What the rules may get wrong.
enum class RuleMistake { kNoRounding, kFewerTours, kLivesLonger };
class WrongRule final : public TourRule {
 public:
  WrongRule(std::unique_ptr<TourRule> inner, RuleMistake mistake)
      : inner_(std::move(inner)), mistake_(mistake) {}
  long long toursAt(double target, Random& random) const override {
    const long long right = inner_->toursAt(target, random);
    // A limit that is not made up for.
    if (mistake_ == RuleMistake::kFewerTours) return std::min(right, 4LL);
    if (mistake_ != RuleMistake::kNoRounding) return right;
    return static_cast<long long>(target / inner_->weight());
  }
  bool goesOn(long long made, double target, Random& random) const override {
    const double seen = mistake_ == RuleMistake::kLivesLonger ? 1.25 * target : target;
    return inner_->goesOn(made, seen, random);
  }
  double level() const override { return inner_->level(); }
  double weight() const override { return inner_->weight(); }

 private:
  std::unique_ptr<TourRule> inner_;
  RuleMistake mistake_;
};

TEST(TourRules, MistakesAreSeenSlow) {
  const World world(exactnessScenes()[0]);
  const double mean = meanTarget(world);
  const BlockMoments reference = byBdpt(world, 400000);
  const auto passes = [&](std::unique_ptr<TourRule> rule, RuleMistake mistake) {
    const WrongRule wrong(std::move(rule), mistake);
    return compare(byTours(world, wrong, isotropicAlone(world, false), kBatches), reference, mean)
        .passed;
  };
  EXPECT_FALSE(passes(energyRedistribution(mean, 2, 1), RuleMistake::kNoRounding));
  EXPECT_FALSE(passes(energyRedistribution(mean, 1, 10), RuleMistake::kFewerTours));
  EXPECT_FALSE(passes(regeneration(mean, 10), RuleMistake::kLivesLonger));
}

// A kernel that does not keep the target: each step towards the right is accepted half as often as it should be.
class BentStep final : public Mutation {
 public:
  explicit BentStep(std::unique_ptr<Mutation> inner) : inner_(std::move(inner)) {}
  std::string_view name() const override { return "bent"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override {
    const Proposal proposal = inner_->propose(current, proposed, context);
    if (!proposal.made()) return proposal;
    return Proposal::withLogRatio(proposal.logRatio() -
                                  (proposed.path.filmX > current.path.filmX ? 0.7 : 0));
  }

 private:
  std::unique_ptr<Mutation> inner_;
};

TEST(TourRules, AKernelsMistakeIsSeenSlow) {
  const World world(exactnessScenes()[0]);
  const double mean = meanTarget(world);
  const BlockMoments reference = byBdpt(world, 400000);
  for (const auto& rule : {energyRedistribution(mean, 1, 100), regeneration(mean, 100)}) {
    SlotNumbers slots;
    const MutationPlugin& plugin = mutationNamed("lens");
    const OptionSet set = optionsOf(plugin, {"lens", "lens", {}});
    const MutationSetup setup{world.target, world.techniques, 1, set, slots};
    KernelMixture kernels = world.alone(std::make_unique<BentStep>(plugin.create(setup)));
    EXPECT_FALSE(
        compare(byTours(world, *rule, std::move(kernels), kBatches), reference, mean).passed);
  }
}

// Of 200 short renders the 95 % intervals by the errors that --stats tells hold what is right between 92 and 98 times
// of 100: for the whole film, and for the blocks that are bright enough for some dozens of tours to get there. (What
// three or four have found is no normal variate.)
class ErrorBars : public ::testing::TestWithParam<const char*> {};

TEST_P(ErrorBars, HoldSlow) {
  if (!std::getenv("H2MC_THOROUGH"))
    GTEST_SKIP() << "200 renders take minutes: H2MC_THOROUGH=yes makes them";
  const World world(exactnessScenes()[0]);
  const BlockMoments reference = byBdpt(world, 4000000);
  constexpr int kRuns = 200, kBlocks = BlockMoments::kColumns * BlockMoments::kRows;
  int inside = 0, all = 0, wholeInside = 0;
  for (int run = 0; run < kRuns; ++run) {
    RenderRequest request;
    request.budget.mutationsPerPixel = 520;
    request.seed = static_cast<std::uint64_t>(run) + 1;
    const RenderResult result = renderTiny(GetParam(), world.scene, request,
                                           {{"maxDepth", std::to_string(world.maxLength)},
                                            {"directSamples", "0"},
                                            {"luminanceSamples", "2000"},
                                            {"chainLength", "5"},
                                            {"tourLength", "5"}});
    const auto holds = [](double value, double error, const Moments& right) {
      return std::abs(value - right.mean()) < 1.96 * std::hypot(error, right.standardError());
    };
    const nlohmann::json& blocks = result.statistics["blocks"];
    for (int k = 0; k < kBlocks; ++k) {
      const Moments& right =
          reference.block(k % BlockMoments::kColumns, k / BlockMoments::kColumns);
      if (!(right.mean() > reference.whole().mean() / 2)) continue;
      inside +=
          holds(blocks["mean luminance"][at(k)].get<double>() / world.scene.radianceUnit,
                blocks["standard error"][at(k)].get<double>() / world.scene.radianceUnit, right);
      ++all;
    }
    wholeInside += holds(result.meanLuminance / world.scene.radianceUnit,
                         result.meanLuminanceError / world.scene.radianceUnit, reference.whole());
  }
  const double blocks = static_cast<double>(inside) / all;
  const double whole = static_cast<double>(wholeInside) / kRuns;
  std::printf("%s: 95 %% intervals hold %.3f of blocks, %.3f of films\n", GetParam(), blocks,
              whole);
  EXPECT_GT(blocks, 0.92);
  EXPECT_LT(blocks, 0.98);
  EXPECT_GT(whole, 0.92);
  EXPECT_LT(whole, 0.985);
}

INSTANTIATE_TEST_SUITE_P(Of, ErrorBars, ::testing::Values("erpt", "restore"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace h2mc::test
