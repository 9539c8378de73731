// SPDX-License-Identifier: MIT
// FLIP and HDR-FLIP: what they must give on pictures for which it is known.
#include "render/image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "render/image/metrics.h"

namespace h2mc {
namespace {

Image constant(int width, int height, const Rgbf& color) {
  Image image(width, height);
  for (Rgbf& p : image.pixels) p = color;
  return image;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Flip, OfTheSamePictureIsZero) {
  Image image(12, 9);
  for (int i = 0; i < 12 * 9; ++i) image.pixels[i] = Rgbf(0.01f * i, 0.5f, 1 - 0.005f * i);
  for (const float v : flip(image, image)) EXPECT_EQ(v, 0);
  EXPECT_EQ(HdrFlip(image)(image), 0);
}

// Green and blue are the ends of the scale, by definition.
TEST(Flip, OfGreenAndBlueIsOne) {
  const Image green = constant(30, 30, Rgbf(0, 1, 0)), blue = constant(30, 30, Rgbf(0, 0, 1));
  EXPECT_NEAR(mean(flip(green, blue)), 1, 1e-3);
  EXPECT_NEAR(mean(flip(blue, green)), 1, 1e-3);
}

// Flat greys: no chroma, no features; the distance is that of CIELAB's lightness,
// with the exponent 0.7 and 0.95 of the scale for 0.4 of the largest distance.
TEST(Flip, OfGreysFollowsLightness) {
  const auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
  const double largest = [] {
    // Hunt-adjusted Lab of the primaries, worked out by hand from the sRGB matrix.
    const auto lab = [](double x, double y, double z) {
      const auto f = [](double t) { return std::cbrt(t); };
      const double l = 116 * f(y) - 16;
      return std::array<double, 3>{l, 0.01 * l * 500 * (f(x) - f(y)),
                                   0.01 * l * 200 * (f(y) - f(z))};
    };
    const auto g = lab(0.3575761 / 0.95047, 0.7151522, 0.1191920 / 1.08883);
    const auto b = lab(0.1804375 / 0.95047, 0.0721750, 0.9503041 / 1.08883);
    return std::pow(std::abs(g[0] - b[0]) + std::hypot(g[1] - b[1], g[2] - b[2]), 0.7);
  }();
  for (const auto& [a, b] : {std::pair{0.2, 0.25}, {0.1, 0.9}, {0.5, 0.51}}) {
    const double e = std::pow(std::abs(lightness(a) - lightness(b)), 0.7);
    const double expected = e < 0.4 * largest ? 0.95 * e / (0.4 * largest)
                                              : 0.95 + 0.05 * (e - 0.4 * largest) / (0.6 * largest);
    const Image left = constant(20, 20, Rgbf(static_cast<float>(a)));
    const Image right = constant(20, 20, Rgbf(static_cast<float>(b)));
    EXPECT_NEAR(mean(flip(left, right)), expected, 2e-3) << a << " " << b;
  }
}

TEST(Flip, GrowsWithTheDifferenceAndIsSymmetric) {
  const Image reference = constant(24, 24, Rgbf(0.4f));
  double before = 0;
  for (const float d : {0.02f, 0.05f, 0.1f, 0.3f}) {
    Image image = reference;
    for (int y = 8; y < 16; ++y)
      for (int x = 8; x < 16; ++x) image.at(x, y) = Rgbf(0.4f + d);
    const double value = mean(flip(image, reference));
    EXPECT_GT(value, before);
    EXPECT_NEAR(mean(flip(reference, image)), value, 1e-6);
    before = value;
  }
}

// A checkerboard of single pixels is blurred to grey from far away and seen from near by.
TEST(Flip, FineDetailIsSeenFromNearOnly) {
  Image board(40, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) board.at(x, y) = Rgbf((x + y) % 2 ? 0.55f : 0.45f);
  const Image grey = constant(40, 40, Rgbf(0.5f));
  EXPECT_LT(mean(flip(board, grey, 120)), 0.3 * mean(flip(board, grey, 8)));
}

TEST(HdrFlip, ExposuresReachFromTheBrightestToTheMedian) {
  Image image = constant(10, 10, Rgbf(0.25f));
  image.at(3, 3) = Rgbf(64);
  const FlipExposures exposures = flipExposures(image);
  EXPECT_NEAR(exposures.stop - exposures.start, 8, 1e-5);  // 64 / 0.25 = 2^8
  EXPECT_EQ(exposures.count, 8);
  EXPECT_NEAR(exposures.at(exposures.count - 1), exposures.stop, 1e-12);
  EXPECT_EQ(flipExposures(constant(4, 4, Rgbf(3))).count, 2);
  EXPECT_TRUE(std::isfinite(flipExposures(constant(4, 4, Rgbf(0))).stop));
}

// An error in what is too bright to be shown at one exposure is seen at another; and brightness as a
// whole does not matter.
TEST(HdrFlip, SeesHighlightsAndIgnoresTheScale) {
  Image reference = constant(32, 32, Rgbf(0.2f)), image = reference;
  for (int y = 8; y < 24; ++y)
    for (int x = 8; x < 24; ++x) {
      reference.at(x, y) = Rgbf(40);
      image.at(x, y) = Rgbf(20);
    }
  const double error = HdrFlip(reference)(image);
  EXPECT_GT(error, 0.02);
  for (Image* scaled : {&reference, &image})
    for (Rgbf& p : scaled->pixels) p *= 16.f;
  EXPECT_NEAR(HdrFlip(reference)(image), error, 1e-3);
  EXPECT_NEAR(findMetric("hdr-flip")->compute(image, reference), error, 1e-3);
}

}  // namespace
}  // namespace h2mc
