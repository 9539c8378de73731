// SPDX-License-Identifier: MIT
#include "mcmc/render/direct_lighting.h"

#include <gtest/gtest.h>

#include <random>

#include "image_check.h"
#include "mcmc/render/integrator_choice.h"

namespace h2mc {
namespace {

// Where a picture is `mean`, an estimate by so many samples of standard deviation `sigma` times it.
TwoEstimates noisy(const Image& mean, float sigma, double samplesA, double samplesB) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  TwoEstimates result{mean, mean, samplesA, samplesB};
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    result.a.pixels[i] *= 1 + sigma / static_cast<float>(std::sqrt(samplesA)) * normal(random);
    result.b.pixels[i] *= 1 + sigma / static_cast<float>(std::sqrt(samplesB)) * normal(random);
  }
  return result;
}

Image stripes(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = Rgbf(x % 2 ? 100.f : 1.f);
  return image;
}

// The standard error of the estimate is a hundredth of it here.
TEST(Noise, VarianceIsThatOfOneSample) {
  const Image mean = stripes(160, 125), black(160, 125);
  const double floor = 0.1 * 50.5;
  double expected = 0;
  for (const double value : {1., 100.}) expected += 0.5 * squared(0.3 * value / (value + floor));
  for (const auto& [na, nb] : {std::pair{4., 4.}, std::pair{100., 25.}}) {
    const TwoEstimates estimates = noisy(mean, 0.3f, na, nb);
    EXPECT_NEAR(varianceOfOneSample(estimates, relativeWeights(mean, black, 1, 1)), expected,
                0.05 * expected);
  }
  EXPECT_EQ(varianceOfOneSample({mean, {}, 4, 0}, relativeWeights(mean, black, 1, 1)), 0);
}

TEST(Noise, NoisyPartCountsByCells) {
  const Image mean = stripes(8, 6), black(8, 6);
  const double floor = 0.1 * 50.5;
  const std::vector<double> sharp = relativeWeights(mean, black, 2, 2);
  EXPECT_NEAR(sharp[0], 1 / squared(1 + floor), 1e-6);
  EXPECT_NEAR(sharp[1], 1 / squared(100 + floor), 1e-8);
  for (const double weight : relativeWeights(black, mean, 2, 2))
    EXPECT_NEAR(weight, 1 / squared(50.5 + floor), 1e-8);
  for (const double weight : relativeWeights(black, black, 3, 3)) EXPECT_EQ(weight, 0);
}

TEST(Noise, MeanIsThatOfAllSamples) {
  TwoEstimates two{Image(1, 1), Image(1, 1), 1, 3};
  two.a.pixels[0] = Rgbf(4);
  EXPECT_FLOAT_EQ(two.mean().pixels[0].x, 1);
  two.b = {};
  EXPECT_FLOAT_EQ(two.mean().pixels[0].x, 4);
}

TEST(DirectLighting, SharesMakeTheVarianceLeast) {
  const auto variance = [](double ratio, double d, double costD, double m, double costM) {
    const double mutations = 1 / (costM + ratio * costD);
    return d / (ratio * mutations) + m / mutations;
  };
  for (const double d : {0.01, 1.})
    for (const double costD : {0.5, 3.}) {
      const double m = 0.7, costM = 2, best = samplesAMutation(d, costD, m, costM);
      for (const double factor : {0.8, 1.25})
        EXPECT_GT(variance(best * factor, d, costD, m, costM), variance(best, d, costD, m, costM));
    }
  EXPECT_EQ(samplesAMutation(0, 1, 1, 1), 0);
  // Chains that have shown no noise keep a tenth of the cost.
  const double most = samplesAMutation(1, 2, 0, 3);
  EXPECT_NEAR(most * 2 / (most * 2 + 3), 0.9, 1e-12);
  EXPECT_EQ(samplesAMutation(1e9, 2, 1e-9, 3), most);
}

long long directSamples(const std::string& name) {
  const Scene scene = test::readTestScene(
      std::string(H2MC_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".xml", 32, 24);
  RenderRequest request;
  request.budget.mutationsPerPixel = 64;
  return chooseIntegrator("mmlt:chains=32,bootstrapSamples=4000", scene)
      .integrator->render(scene, request)
      .statistics["direct lighting"]["samples per pixel"];
}

// Lamps seen in glossy plates are all that is noisy in the one; the other's caustics need the chains.
TEST(DirectLighting, GetsWhatTheSceneNeeds) {
  EXPECT_GT(directSamples("veach-mis"), 200);
  EXPECT_LT(directSamples("swords"), 64);
}

}  // namespace
}  // namespace h2mc
