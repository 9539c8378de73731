// SPDX-License-Identifier: MIT
// What chains leave, and the picture that is made of it.
#include "mcmc/populations/image_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/core/index.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

FilmSettings settings(int width, int height) {
  FilmSettings s;
  s.width = width;
  s.height = height;
  return s;
}

// A one-dimensional picture as "paths": radiance at x, from two techniques' worth of brightness.
double radiance(double x) { return 0.2 + 8 * x * x * x; }
constexpr double kMean = 0.2 + 2;

// A round of independent draws from f / b and of large steps, each of which is a sample by itself, f being the
// radiance times an importance (1 + x).
void makePart(ChainFilms& films, Random& random, int mutations, int largeSteps, double share) {
  const auto target = [](double x) { return radiance(x) * (1 + x); };
  const auto grey = [](double value) { return Rgbf(static_cast<float>(value)); };
  for (int i = 0; i < mutations; ++i) {
    float x;
    do x = random.uniform();
    while (target(x) < 16.4 * random.uniformDouble());
    films.states.splat(x, 0.5f, grey(radiance(x)), 1, target(x), {share});
  }
  for (int i = 0; i < largeSteps; ++i) {
    const float x = random.uniform();
    films.samples.splat(x, 0.5f, grey(radiance(x)), target(x), {share});
  }
}

// Its mean is the picture, however large the share of samples and with a guess of b that is wrong. Mean of 40
// estimates against the truth, by 4 of the standard errors that they show: of 24 pixels one is further off in one of
// 600 choices of the seed, and more often for Student's t: in one of 100.
TEST(ImageEstimate, IsRight) {
  constexpr int kRuns = 40, kPixels = 8;
  for (const double share : {0.0, 0.7, 20.0}) {
    std::vector<double> sum(kPixels, 0), squares(kPixels, 0);
    for (int run = 0; run < kRuns; ++run) {
      Random random(3, static_cast<std::uint64_t>(100 * share), static_cast<std::uint64_t>(run));
      ImageEstimate estimate(settings(kPixels, 1), 1);
      for (int epoch = 0; epoch < 2; ++epoch) {
        estimate.begin();
        for (int round = 0; round < 3; ++round) {
          ChainFilms films[2];
          const int mutations = 2000, largeSteps = share > 0 ? 500 : 0;
          std::vector<ImageEstimate::Part> parts;
          for (int half = 0; half < 2; ++half) {
            makePart(films[half], random, mutations, largeSteps, share);
            estimate.sort(films[half]);
            parts.push_back({&films[half], half, mutations, largeSteps});
          }
          estimate.add(parts);
        }
        const TwoEstimates halves = estimate.halves(kMean);
        EXPECT_NEAR(halves.samplesA, 3 * 2000. / kPixels, 1e-9);
        const Image now = estimate.image(kMean);
        for (std::size_t i = 0; epoch == 0 && i < kPixels; ++i)
          EXPECT_NEAR((halves.a.pixels[i].x + halves.b.pixels[i].x) / 2, now.pixels[i].x,
                      0.1 * now.pixels[i].x);
        estimate.end();
        EXPECT_EQ(estimate.image(kMean).pixels, now.pixels);
      }
      const Image image = estimate.image(kMean);
      for (std::size_t i = 0; i < kPixels; ++i) {
        sum[i] += image.pixels[i].x;
        squares[i] += squared(static_cast<double>(image.pixels[i].x));
      }
    }
    for (std::size_t i = 0; i < kPixels; ++i) {
      const double a = at(i) / double(kPixels), b = (at(i) + 1) / double(kPixels);
      const double expected = 0.2 + 2 * (b * b * b * b - a * a * a * a) / (b - a);
      const double mean = sum[i] / kRuns;
      const double error = std::sqrt((squares[i] / kRuns - mean * mean) / (kRuns - 1));
      EXPECT_NEAR(mean, expected, 4 * error) << "share " << share << " pixel " << i;
    }
  }
}

// A stretch of few mutations, in which large steps were luckier than all that the mean luminance is known from.
TEST(ImageEstimate, IsNeverNegative) {
  Random random(1, 2, 3);
  ImageEstimate estimate(settings(8, 1), 1);
  estimate.begin();
  ChainFilms films;
  makePart(films, random, 40, 10, 20);
  estimate.sort(films);
  const ImageEstimate::Part part{&films, 0, 40, 10};
  estimate.add({&part, 1});
  const double luminance = 0.1 * kMean;
  for (const Rgbf& pixel : estimate.image(luminance).pixels) EXPECT_GE(pixel.x, 0);
  for (const Rgbf& pixel : estimate.halves(luminance).a.pixels) EXPECT_GE(pixel.x, 0);
  estimate.end();
  for (const Rgbf& pixel : estimate.image(luminance).pixels) EXPECT_GE(pixel.x, 0);
}

// Floats are enough: equal splats, which all round alike, come out as they should. In one go they would be off by a
// percent.
TEST(ImageEstimate, ManyMutationsStayAccurate) {
  constexpr int kRounds = 400, kMutations = 10000, kPixels = 16;
  ImageEstimate estimate(settings(kPixels, 1), 1);
  estimate.begin();
  for (int round = 0; round < kRounds; ++round) {
    ChainFilms films;
    for (int i = 0; i < kMutations; ++i)
      films.states.splat((static_cast<float>(i % kPixels) + 0.5f) / kPixels, 0.5f, Rgbf(0.1f), 1,
                         0.1, {0.033});
    estimate.sort(films);
    const ImageEstimate::Part part{&films, 0, kMutations, 0};
    estimate.add({&part, 1});
  }
  for (const Rgbf& pixel : estimate.image(1).pixels)
    EXPECT_NEAR(pixel.x, 0.1 / 0.133, 1e-4 * 0.1 / 0.133);
}

}  // namespace
}  // namespace h2mc
