// SPDX-License-Identifier: MIT
#include "mcmc/chain/kernel_mixture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "toy_kernels.h"
#include "toy_target.h"

namespace h2mc::test {
namespace {

constexpr std::size_t kIsotropic = 1, kHamiltonian = 2;

struct Mixture {
  ToyTarget target;
  TechniqueDistribution techniques = evenly(ToyTarget::kTechniques);
  KernelMixture kernels =
      toyKernels(target, techniques, {"", 0.2, 0.5, 0.5, StepShape::kGaussian, 0.1f});

  Mixture(std::optional<double> isotropicCost, std::optional<double> hamiltonianCost) {
    kernels.meanTarget = 2;
    kernels.small[0].cost = isotropicCost;
    kernels.small[1].cost = hamiltonianCost;
  }
  static Path state(float target) {
    Path path(2);
    path.technique = ToyTarget::kTechniques[1];
    path.target = target;
    return path;
  }
  // How often a state chooses each kind.
  std::vector<double> frequencies(const Path& state) const {
    constexpr int kDraws = 40000;
    std::vector<double> result(static_cast<std::size_t>(kernels.kinds()), 0);
    Random random(3, 0, 0);
    for (int i = 0; i < kDraws; ++i) result[kernels.choose(state, random)->kind] += 1.0 / kDraws;
    return result;
  }
};

double logRatio(const KernelMixture& kernels, std::size_t kind, const Path& current,
                const Path& proposed) {
  return kernels.logRatio({kind, kernels.probability(kind, current)}, proposed);
}

// The probability that comes with a draw is that of its kind.
TEST(KernelMixture, ChoicesKnowTheirProbability) {
  const Mixture m(1, 4);
  const Path state = Mixture::state(3);
  Random random(5, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const auto choice = m.kernels.choose(state, random);
    ASSERT_TRUE(choice);
    EXPECT_DOUBLE_EQ(choice->probability, m.kernels.probability(choice->kind, state));
  }
}

TEST(KernelMixture, OctaveIsTheBinaryLogarithmOverTheMean) {
  const Mixture m(1, 4);
  EXPECT_EQ(m.kernels.octave(2), 0);
  EXPECT_EQ(m.kernels.octave(3.9), 0);
  EXPECT_EQ(m.kernels.octave(4), 1);
  EXPECT_EQ(m.kernels.octave(1.9), -1);
  EXPECT_EQ(m.kernels.octave(1e30), kHighestOctave);
  EXPECT_EQ(m.kernels.octave(1e-30), -kHighestOctave);
}

TEST(KernelMixture, SharesAreTheGivenOnesBeforeItLearns) {
  const Mixture m(1, 4);
  const auto f = m.frequencies(Mixture::state(2));
  EXPECT_NEAR(f[0], 0.2, 0.01);
  EXPECT_NEAR(f[kIsotropic], 0.4, 0.013);
  EXPECT_EQ(logRatio(m.kernels, kIsotropic, Mixture::state(2), Mixture::state(200)), 0);
}

TEST(KernelMixture, LearnsWhatPaysAtEachOctave) {
  Mixture m(1, 4);
  ChainStatistics statistics(m.kernels.kinds(), 2);
  const auto set = [&](std::size_t kind, int octave, double acceptance) {
    statistics.octaves[kind][octaveRow(octave)] = {1000000, acceptance * 1000000};
  };
  set(kIsotropic, 0, 0.6);
  set(kHamiltonian, 0, 0.6);
  set(kIsotropic, 8, 0.02);
  set(kHamiltonian, 8, 0.32);
  m.kernels.learn(statistics);
  // Equally accepted: 1 to 4^-4; sixteen times better for four times the cost: 1 to 4^4.
  const auto share = [](double odds) {
    return KernelMixture::kLeast + (1 - 2 * KernelMixture::kLeast) * odds / (1 + odds);
  };
  const Path dim = Mixture::state(2), bright = Mixture::state(2 * 256);
  const auto atDim = m.frequencies(dim), atBright = m.frequencies(bright);
  EXPECT_NEAR(atDim[kHamiltonian], 0.8 * share(1 / 256.), 0.005);
  EXPECT_NEAR(atBright[kHamiltonian], 0.8 * share(256), 0.005);
  EXPECT_NEAR(atBright[0], 0.2, 0.01);
  EXPECT_NEAR(logRatio(m.kernels, kHamiltonian, dim, bright),
              std::log(share(256) / share(1 / 256.)), 0.02);
  EXPECT_NEAR(logRatio(m.kernels, kHamiltonian, bright, dim),
              -logRatio(m.kernels, kHamiltonian, dim, bright), 1e-12);
  EXPECT_EQ(logRatio(m.kernels, 0, dim, bright), 0);
}

// States of a chain that stays within a pixel count as one, at each octave by itself.
TEST(KernelMixture, DividesByHowLongChainsStay) {
  Mixture m(1, 4);
  m.kernels.meanTarget = 2;
  m.kernels.baseSamples = 0.3;
  // Before anything is known samples of a brief render have nearly all.
  m.kernels.brief = true;
  EXPECT_DOUBLE_EQ(m.kernels.division().ofState(2),
                   2 + 64 * (m.kernels.largeProbability + 0.3) * 2);
  ChainStatistics statistics(m.kernels.kinds(), 2);
  statistics.octaves[kIsotropic][octaveRow(8)] = {600, 10};
  statistics.octaves[kHamiltonian][octaveRow(8)] = {400, 10};
  statistics.departures[octaveRow(8)] = 9;
  m.kernels.learn(statistics);
  EXPECT_DOUBLE_EQ(m.kernels.division().ofState(2), 2 + (m.kernels.largeProbability + 2 * 0.3) * 2);
  m.kernels.dividesByHolding = true;
  m.kernels.learn(statistics);
  const Division division = m.kernels.division();
  const double level = (m.kernels.largeProbability + 0.3) * 2;
  EXPECT_DOUBLE_EQ(division.ofState(2), 2 + level);
  EXPECT_DOUBLE_EQ(division.ofState(2 * 256), 2 * 256 + 100 * level);
  for (const double f : {1e-9, 2., 600.})
    EXPECT_NEAR(f / division.ofState(f) + division.ofSample(f), 1, 1e-12);
}

TEST(KernelMixture, WhatHasNoCostKeepsItsShare) {
  Mixture m({}, 4);
  learnLeaps(m.kernels);
  for (const float target : {2.f, 4.f, 300.f})
    EXPECT_NEAR(m.frequencies(Mixture::state(target))[kIsotropic], 0.4, 0.013) << target;
}

// A kernel for one technique alone.
class OnlyFor final : public Mutation {
 public:
  explicit OnlyFor(Technique technique) : technique_(technique) {}
  std::string_view name() const override { return "only"; }
  bool applies(const Path& path) const override { return path.technique == technique_; }
  Proposal propose(ChainState&, ChainState&, MutationContext&) override { return Proposal::none(); }

 private:
  Technique technique_;
};

TEST(KernelMixture, SharesAreThoseOfTheKernelsThatApply) {
  Mixture m({}, {});
  m.kernels.small.push_back({std::make_unique<OnlyFor>(ToyTarget::kTechniques[0]), 1, {}});
  Path other = Mixture::state(2), own = other;
  own.technique = ToyTarget::kTechniques[0];
  // Shares are .5, .5 and 1 of what is not large, where all apply.
  const auto all = m.frequencies(own), two = m.frequencies(other);
  EXPECT_NEAR(all[kIsotropic], 0.2, 0.01);
  EXPECT_NEAR(all[3], 0.4, 0.013);
  EXPECT_NEAR(two[kIsotropic], 0.4, 0.013);
  EXPECT_EQ(two[3], 0);
  for (std::size_t kind = 0; kind < 4; ++kind) {
    EXPECT_NEAR(m.kernels.probability(kind, own), all[kind], 0.013);
    EXPECT_NEAR(m.kernels.probability(kind, other), two[kind], 0.013);
  }
  // Whatever changes a kernel's share is in the ratio: half as much here as there.
  EXPECT_NEAR(logRatio(m.kernels, kIsotropic, own, other), std::log(2), 1e-12);
  EXPECT_EQ(logRatio(m.kernels, 3, own, other), -std::numeric_limits<double>::infinity());
  // Where nothing applies the chain stays.
  m.kernels.small.erase(m.kernels.small.begin(), m.kernels.small.begin() + 2);
  Random random(1, 0, 0);
  int stays = 0;
  for (int i = 0; i < 1000; ++i) stays += !m.kernels.choose(other, random).has_value();
  EXPECT_NEAR(stays, 800, 60);
}

}  // namespace
}  // namespace h2mc::test
