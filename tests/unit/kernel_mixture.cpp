#include "mcmc/kernel_mixture.h"

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

  explicit Mixture(double isotropicCost, double hamiltonianCost) {
    kernels.brightness = 2;
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
    for (int i = 0; i < kDraws; ++i) result[kernels.choose(state, random)] += 1.0 / kDraws;
    return result;
  }
};

TEST(KernelMixture, LevelIsTheBinaryLogarithmOverTheBrightness) {
  const Mixture m(1, 4);
  EXPECT_EQ(m.kernels.level(2), 0);
  EXPECT_EQ(m.kernels.level(3.9), 0);
  EXPECT_EQ(m.kernels.level(4), 1);
  EXPECT_EQ(m.kernels.level(1.9), -1);
  EXPECT_EQ(m.kernels.level(1e30), kHighestLevel);
  EXPECT_EQ(m.kernels.level(1e-30), -kHighestLevel);
}

TEST(KernelMixture, SharesAreTheGivenOnesBeforeItLearns) {
  const Mixture m(1, 4);
  const auto f = m.frequencies(Mixture::state(2));
  EXPECT_NEAR(f[0], 0.2, 0.01);
  EXPECT_NEAR(f[kIsotropic], 0.4, 0.013);
  EXPECT_EQ(m.kernels.logRatio(kIsotropic, Mixture::state(2), Mixture::state(200)), 0);
}

TEST(KernelMixture, LearnsWhatPaysAtEachLevel) {
  Mixture m(1, 4);
  ChainStatistics statistics(m.kernels.kinds(), 2);
  const auto set = [&](std::size_t kind, int level, double acceptance) {
    statistics.levels[kind][KernelMixture::at(level)] = {1000000, acceptance * 1000000};
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
  EXPECT_NEAR(m.kernels.logRatio(kHamiltonian, dim, bright), std::log(share(256) / share(1 / 256.)),
              0.02);
  EXPECT_NEAR(m.kernels.logRatio(kHamiltonian, bright, dim),
              -m.kernels.logRatio(kHamiltonian, dim, bright), 1e-12);
  EXPECT_EQ(m.kernels.logRatio(0, dim, bright), 0);
}

TEST(KernelMixture, WhatHasNoCostKeepsItsShare) {
  Mixture m(0, 4);
  learnLeaps(m.kernels);
  for (const float target : {2.f, 4.f, 300.f})
    EXPECT_NEAR(m.frequencies(Mixture::state(target))[kIsotropic], 0.4, 0.013) << target;
}

}  // namespace
}  // namespace h2mc::test
