// SPDX-License-Identifier: MIT
// The Hamiltonian Gaussian against the dynamics it stands for, and its density against its samples.
#include <gtest/gtest.h>

#include <cmath>

#include "mcmc/mutations/gaussian.h"
#include "mcmc/mutations/technique_distribution.h"
#include "render/core/index.h"

namespace h2mc {
namespace {

Derivative oneDimension(float gradient, float hessian) {
  Derivative d;
  d.dimension = 1;
  d.gradient[0] = gradient;
  d.hessian[0] = hessian;
  return d;
}

// The end point of x'' = f'(x) / m from 0 with velocity v, f = g x + l x^2 / 2, m = |l|: leapfrog.
double trajectory(double g, double l, double v, double length) {
  constexpr int kSteps = 20000;
  const double step = length / kSteps, mass = std::abs(l);
  double x = 0;
  for (int i = 0; i < kSteps; ++i) {
    v += 0.5 * step * (g + l * x) / mass;
    x += step * v;
    v += 0.5 * step * (g + l * x) / mass;
  }
  return x;
}

TEST(HamiltonianGaussian, IsTheEndPointOfTheDynamicsTimesThePrior) {
  for (const double l : {-3.0, 2.0})
    for (const double length : {0.5, 1.5707963}) {
      const double g = 0.7;
      // The end point is linear in the velocity, which is N(0, 1 / m): two runs tell all.
      const double mean = trajectory(g, l, 0, length);
      const double slope = trajectory(g, l, 1, length) - mean;
      const double variance = slope * slope / std::abs(l);
      HamiltonianSettings settings;
      settings.sigma = 0.8f;
      settings.trajectory = static_cast<float>(length);
      settings.maxDrift = 1e6f;
      Gaussian gaussian;
      ASSERT_TRUE(hamiltonianGaussian(oneDimension(static_cast<float>(g), static_cast<float>(l)),
                                      settings, gaussian));
      // Product with N(0, sigma^2): precisions add.
      const double precision = 1 / variance + 1 / (0.8 * 0.8);
      EXPECT_NEAR(gaussian.deviation[0], std::sqrt(1 / precision), 1e-4) << l << " " << length;
      EXPECT_NEAR(gaussian.mean[0] * gaussian.vectors[0], mean / variance / precision, 1e-4)
          << l << " " << length;
    }
}

TEST(HamiltonianGaussian, IsThePriorOnFlatGround) {
  Gaussian gaussian;
  HamiltonianSettings settings;
  settings.sigma = 0.03f;
  ASSERT_TRUE(hamiltonianGaussian(oneDimension(0, 0), settings, gaussian));
  EXPECT_FLOAT_EQ(gaussian.deviation[0], 0.03f);
  EXPECT_EQ(gaussian.mean[0], 0);
}

// Nothing is decomposed where it would not matter, and what is left out is small.
TEST(HamiltonianGaussian, IsThePriorWhereDerivativesAreNegligible) {
  HamiltonianSettings settings;
  settings.sigma = 0.01f;
  Gaussian gaussian;
  ASSERT_TRUE(hamiltonianGaussian(oneDimension(4.9f, -490), settings, gaussian));
  EXPECT_TRUE(gaussian.alongAxes);
  EXPECT_EQ(gaussian.deviation[0], 0.01f);
  for (const auto& [gradient, hessian] : {std::pair{5.1f, 0.f}, std::pair{0.f, -510.f}}) {
    ASSERT_TRUE(hamiltonianGaussian(oneDimension(gradient, hessian), settings, gaussian));
    EXPECT_FALSE(gaussian.alongAxes);
    EXPECT_NEAR(gaussian.deviation[0], 0.01, 0.01 * 0.03);
    EXPECT_NEAR(gaussian.mean[0], 0, 0.01 * 0.06);
  }
}

TEST(HamiltonianGaussian, BoundsTheDrift) {
  Gaussian gaussian;
  HamiltonianSettings settings;
  settings.maxDrift = 2;
  ASSERT_TRUE(hamiltonianGaussian(oneDimension(1e9f, -1), settings, gaussian));
  EXPECT_FLOAT_EQ(std::abs(gaussian.mean[0]), 2 * gaussian.deviation[0]);
}

TEST(HamiltonianGaussian, FallsBackWhenDerivativesAreNotFinite) {
  Gaussian gaussian;
  HamiltonianSettings settings;
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(hamiltonianGaussian(oneDimension(bad, -1), settings, gaussian));
    EXPECT_TRUE(gaussian.alongAxes);
    EXPECT_FALSE(hamiltonianGaussian(oneDimension(0, bad), settings, gaussian));
    EXPECT_FLOAT_EQ(gaussian.deviation[0], settings.sigma);
  }
}

TEST(HamiltonianGaussian, SamplesHaveItsDensity) {
  Derivative d;
  d.dimension = 3;
  const float gradient[3] = {30, -10, 5}, hessian[6] = {-900, 700, -800, 100, -50, 2000};
  std::copy_n(gradient, 3, d.gradient);
  std::copy_n(hessian, 6, d.hessian);
  HamiltonianSettings settings;
  settings.sigma = 0.05f;
  Gaussian gaussian;
  ASSERT_TRUE(hamiltonianGaussian(d, settings, gaussian));
  // For x drawn from p, log p(x) has mean logNormalisation - n / 2 and variance n / 2.
  Random random(3, 0, 0);
  constexpr int kSamples = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    float offset[3];
    gaussian.sample(random, offset);
    const double y = gaussian.logDensity(offset) - gaussian.logNormalisation;
    sum += y;
    squares += y * y;
  }
  const double mean = sum / kSamples;
  // Five standard errors: false alarms below 1e-6.
  EXPECT_NEAR(mean, -1.5, 5 * std::sqrt(1.5 / kSamples));
  EXPECT_NEAR(squares / kSamples - mean * mean, 1.5, 0.05);
  // logNormalisation is that of the deviations, whose product is the root of the determinant.
  double product = 1;
  for (int i = 0; i < 3; ++i) product *= gaussian.deviation[i];
  EXPECT_NEAR(gaussian.logNormalisation, -std::log(product), 1e-5);
}

TEST(TechniqueDistribution, IndexesEveryTechniqueOnce) {
  const TechniqueDistribution techniques(3, 6);
  for (int i = 0; i < techniques.size(); ++i) {
    EXPECT_EQ(techniques.index(techniques.technique(i)), i);
    EXPECT_EQ(techniques.technique(i).dimension(), 2 * techniques.technique(i).length());
  }
}

TEST(TechniqueDistribution, LeavesOutWhatCannotBe) {
  TechniqueDistribution techniques(1, 2);
  EXPECT_EQ(techniques.probability(Technique{1, 1}), 0);
  std::vector<double> weights(static_cast<std::size_t>(techniques.size()), 0);
  weights[at(techniques.index({0, 3}))] = 1;
  techniques.setWeights(weights, std::vector<bool>(weights.size(), true));
  double sum = 0;
  for (int i = 0; i < techniques.size(); ++i) {
    sum += techniques.probability(i);
    if (!(techniques.technique(i) == Technique{1, 1})) {
      EXPECT_GT(techniques.probability(i), 0);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_GT(techniques.probability(Technique{0, 3}), 0.9);
  EXPECT_EQ(techniques.technique(techniques.choose(0.5f)), (Technique{0, 3}));
}

}  // namespace
}  // namespace h2mc
