// SPDX-License-Identifier: MIT
#include "mcmc/populations/base_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image_check.h"
#include "render/core/index.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

constexpr int kLongest = 4;

// What so many groups leave on a film, and the moments of their luminances.
std::pair<Image, Moments> made(const Scene& scene, int groups, double level) {
  const ImportanceMap everywhere;
  const SceneTarget target(scene, kLongest, everywhere);
  Film film(scene.film);
  Moments luminance;
  NotFiniteCounts notFinite;
  for (int g = 0; g < groups; ++g) {
    BaseSamples samples(target, 2, 5);
    samples.begin(0, g, groups);
    SampleFilm own;
    // In two parts, of which the first leaves a quarter of a sample for the second.
    samples.extendTo(0.25, 24001 / groups, {level}, own, notFinite);
    samples.extendTo(0.25, 48000 / groups, {level}, own, notFinite);
    own.splats.sort(film, 1);
    own.splats.addBand(0, 0, film);
    luminance.add(samples.luminance());
  }
  EXPECT_EQ(luminance.count, 12000);
  EXPECT_EQ(notFinite.count, 0);
  return {film.develop(1. / 12000), luminance};
}

// Sample number n is the same whoever makes it.
TEST(BaseSamples, DoNotDependOnTheGroups) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/cornell/cornell.xml", 8, 8);
  const auto [one, ofOne] = made(scene, 1, 0.3);
  const auto [four, ofFour] = made(scene, 4, 0.3);
  EXPECT_NEAR(ofOne.mean(), ofFour.mean(), 1e-9 * ofOne.mean());
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    EXPECT_NEAR(one.pixels[i].y, four.pixels[i].y, 1e-5 * one.pixels[i].y);
}

// Each pixel gets its share: far above any target the level leaves them everything, and the picture's mean is that of
// the luminances. At a level between, a part of it.
TEST(BaseSamples, TakeWhatTheLevelGivesThem) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/cornell/cornell.xml", 8, 8);
  const auto [all, luminance] = made(scene, 2, 1e9);
  EXPECT_NEAR(meanLuminance(all), luminance.mean(), 1e-4 * luminance.mean());
  const double part = meanLuminance(made(scene, 2, luminance.mean()).first) / luminance.mean();
  EXPECT_GT(part, 0.1);
  EXPECT_LT(part, 0.9);
  EXPECT_EQ(meanLuminance(made(scene, 2, 0).first), 0);
}

// How far apart the pictures of two sets of 32 groups are, relative to their mean, over the columns of a wide film: of
// 32 samples a pixel each.
double columnsApart(const Scene& scene, int secondSequence, int secondPart, int parts) {
  constexpr int kGroups = 32;
  const long long pixels = static_cast<long long>(scene.film.width) * scene.film.height;
  const ImportanceMap everywhere;
  const SceneTarget target(scene, kLongest, everywhere);
  std::vector<double> columns[2];
  for (int half = 0; half < 2; ++half) {
    Film film(scene.film);
    NotFiniteCounts notFinite;
    for (int g = 0; g < kGroups; ++g) {
      BaseSamples samples(target, 2, 5);
      samples.begin(half * secondSequence, half * secondPart + g, parts);
      SampleFilm own;
      samples.extendTo(1, 32 * pixels / kGroups, {1e9}, own, notFinite);
      own.splats.sort(film, 1);
      own.splats.addBand(0, 0, film);
    }
    const Image image = film.develop(1);
    columns[half].resize(at(image.width));
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) columns[half][at(x)] += luminance(image.at(x, y));
  }
  double apart = 0, sum = 0;
  for (std::size_t x = 0; x < columns[0].size(); ++x) {
    apart += std::abs(columns[0][x] - columns[1][x]);
    sum += (columns[0][x] + columns[1][x]) / 2;
  }
  return apart / sum;
}

// Each half of the chains sees the whole film: parts of one sequence would be stripes of it.
TEST(BaseSamples, SequencesFillTheFilmEach) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/cornell/cornell.xml", 192, 8);
  EXPECT_LT(columnsApart(scene, 1, 0, 32), 0.3);
  EXPECT_GT(columnsApart(scene, 0, 32, 64), 0.6);
}

}  // namespace
}  // namespace h2mc
