// SPDX-License-Identifier: MIT
// Replica exchange: changing places keeps both targets, and takes chains between modes that they can't walk to.
#include "mcmc/populations/replicas.h"

#include <gtest/gtest.h>

#include "exactness_world.h"
#include "image_check.h"
#include "mcmc/mutations/isotropic_step.h"
#include "paired_table.h"

namespace h2mc::test {
namespace {

constexpr std::uint64_t kSeed = 4;

// Two chains of independent exact starts, of a target and of another one, change places once: as far as both targets
// are what the exchange takes them for, neither one's states are distributed otherwise than before.
double smallestP(const World& world, const PathTarget& lower, const PathTarget& takenForLower,
                 const PathTarget& upper, const PathTarget& takenForUpper) {
  using namespace detail;
  ExactStarts ofLower(lower, 1, 21), ofUpper(upper, 1, 22);
  std::array<PairedTable, kTables> tables;
  std::array<Path, 2> places{Path(world.maxLength), Path(world.maxLength)};
  Path x(world.maxLength), y(world.maxLength);
  Random random(kSeed, 1, 0);
  int exchanged = 0;
  for (int i = 0; i < 400000; ++i) {
    const double weight = ofLower.start(i, x) * ofUpper.start(i, y);
    if (!(weight > 0)) continue;
    Chain a(lower, x, Random(kSeed, 2, 0)), b(upper, y, Random(kSeed, 3, 0));
    const auto aBefore = cellsOf(a.path(), 1), bBefore = cellsOf(b.path(), 1);
    exchangePlaces(a, takenForLower, b, takenForUpper, random, places);
    const auto aAfter = cellsOf(a.path(), 1), bAfter = cellsOf(b.path(), 1);
    exchanged += aAfter != aBefore;
    for (std::size_t t = 0; t < kTables; ++t) {
      tables[t].add(aBefore[t], aAfter[t], weight);
      // The other chain's cells are others.
      tables[t].add(bBefore[t] + 100000, bAfter[t] + 100000, weight);
    }
  }
  EXPECT_GT(exchanged, 2000);
  double smallest = 1;
  for (const PairedTable& table : tables)
    smallest = std::min(smallest, table.test(static_cast<int>(kTables)).pValue);
  return smallest;
}

TEST(ExchangePlaces, KeepsBothTargetsSlow) {
  for (const ExactnessScene& scene : exactnessScenes()) {
    const World world(scene);
    const double mean = ExactStarts(world.target, 1, 5).meanTarget();
    const TemperedTarget flat(world.scene, world.maxLength, 0.5, mean);
    const double p = smallestP(world, world.target, world.target, flat, flat);
    std::printf("%s: smallest p %.2g\n", scene.name, p);
    EXPECT_GT(p, sidak(kFalseAlarmRate, kVerdicts)) << scene.name;
  }
}

// The importance map forgotten, and another power.
TEST(ExchangePlaces, MistakesAreSeenSlow) {
  const World world(exactnessScenes()[0]);
  const double mean = ExactStarts(world.target, 1, 5).meanTarget();
  const TemperedTarget flat(world.scene, world.maxLength, 0.5, mean);
  const TemperedTarget other(world.scene, world.maxLength, 0.6, mean);
  const TemperedTarget unmapped(world.scene, world.maxLength, 1, mean);
  const double p = sidak(kFalseAlarmRate, kVerdicts);
  EXPECT_LT(smallestP(world, world.target, unmapped, flat, flat), p);
  EXPECT_LT(smallestP(world, world.target, world.target, flat, other), p);
}

// Two lamps in the dark, far from each other, one four times as bright.
Scene twoLamps() {
  static const testing::SceneFolder folder;
  const auto lamp = [](const char* x, const char* radiance) {
    return std::string(
               R"(<shape type="rectangle"><transform name="toWorld"><scale value="0.2"/><translate x=")") +
           x + R"("/></transform><emitter type="area"><rgb name="radiance" value=")" + radiance +
           R"("/></emitter></shape>)";
  };
  return readTestScene(folder.write("lamps.xml", R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="perspective"><transform name="toWorld"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/>
    </transform>
  <float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="16"/>
    <integer name="height" value="12"/></film></sensor>)" +
                                                     lamp("-0.9", "4") + lamp("0.9", "1") +
                                                     "</scene>"));
}

KernelMixture steps(const PathTarget& target, const TechniqueDistribution& techniques,
                    double large) {
  KernelMixture kernels;
  kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
  kernels.largeProbability = large;
  kernels.small.push_back(
      {std::make_unique<IsotropicStep>(target, StepShape::kGaussian, 0.02f), 1, {}});
  return kernels;
}

// Chains by themselves stay at the lamp where they begin. With replicas, of which large steps go anywhere, four out of
// five are at the brighter one in the end, wherever they began.
TEST(Replicas, TakeChainsToFarModesSlow) {
  const Scene scene = twoLamps();
  const ImportanceMap map;
  const SceneTarget target(scene, 1, map);
  TechniqueDistribution techniques(1, 1);
  std::vector<bool> possible(at(techniques.size()), false);
  possible[at(techniques.index({0, 2}))] = true;
  techniques.setWeights(std::vector<double>(possible.begin(), possible.end()), possible);
  Path start(1);
  start.technique = {0, 2};
  Random random(kSeed, 5, 0);
  const auto startAt = [&](bool left) {
    do
      for (auto& u : start.sample.u) u = random.uniform();
    while (!target.evaluate(start) || (start.filmX < 0.5f) != left);
  };
  constexpr int kLadders = 2000, kRounds = 120, kSteps = 4;
  double exchanges = 0;
  for (const bool alone : {true, false}) {
    int left = 0;
    for (int k = 0; k < kLadders; ++k) {
      startAt(k % 2 == 0);
      Chain chain(target, start, Random(kSeed, 6, static_cast<std::uint64_t>(k)));
      KernelMixture kernels = steps(target, techniques, 0);
      Replicas replicas(
          target, Replicas::powers(2, 0.2), 1,
          [&](const PathTarget& flat) { return steps(flat, techniques, 0.3); }, start, kSeed,
          static_cast<std::uint64_t>(k));
      ChainFilms films;
      ChainStatistics statistics(kernels.kinds(), 1);
      MutationContext context;
      for (int i = 0; i < kRounds; ++i) {
        for (int s = 0; s < kSteps; ++s) chain.step(kernels, films, statistics, context);
        chain.flush(kernels, films.states);
        films.clear();
        if (alone) continue;
        replicas.run(kSteps);
        replicas.exchange(chain);
      }
      left += chain.path().filmX < 0.5f;
      if (!alone) exchanges += replicas.rungs()[0].exchanges.expected / (kLadders * kRounds);
    }
    std::printf("%s: %d of %d at the brighter lamp\n", alone ? "alone" : "with replicas", left,
                kLadders);
    if (alone)
      EXPECT_EQ(left, kLadders / 2);
    else
      EXPECT_NEAR(left, 0.8 * kLadders, 4.5 * std::sqrt(0.16 * kLadders));
  }
  std::printf("exchanges accepted: %.3f\n", exchanges);
  EXPECT_GT(exchanges, 0.05);
}

}  // namespace
}  // namespace h2mc::test
