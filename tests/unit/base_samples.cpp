// SPDX-License-Identifier: MIT
#include "mcmc/populations/base_samples.h"

#include <gtest/gtest.h>

#include "image_check.h"
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
    BaseSamples samples(target, 2, 5, g, groups);
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

}  // namespace
}  // namespace h2mc
