// SPDX-License-Identifier: MIT
#include "mcmc/targets/importance_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace h2mc {
namespace {

// Bright to the right: exp(4 x), dimmer below.
Image ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = Rgbf(std::exp(4.f * static_cast<float>(x) / static_cast<float>(width)) /
                            (1 + static_cast<float>(y)));
  return image;
}

float centre(int i, int size) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(size); }

double meanUnder(const ImportanceMap& map, const Image& image) {
  double sum = 0, plain = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double value = luminance(image.at(x, y));
      sum += value * map(centre(x, image.width), centre(y, image.height));
      plain += value;
    }
  return sum / plain;
}

TEST(ImportanceMap, IsOneWithoutAPicture) {
  EXPECT_EQ(ImportanceMap()(0.3f, 0.9f), 1);
  const Image black(8, 8);
  EXPECT_EQ(ImportanceMap(black, black, 2)(0.5f, 0.5f), 1);
  EXPECT_EQ(ImportanceMap(ramp(8, 8), black, 2)(0.5f, 0.5f), 1);
}

TEST(ImportanceMap, KeepsTheTargetsMean) {
  const Image picture = ramp(50, 30);
  Image sampled = picture;
  for (int x = 0; x < 50; ++x) sampled.at(x, 3) *= 7.f;
  for (const int cell : {1, 2, 7, 64})
    EXPECT_NEAR(meanUnder(ImportanceMap(picture, sampled, cell), sampled), 1, 1e-5) << cell;
}

// What varies along one axis alone is blurred along that axis alone, in every row or column alike.
TEST(ImportanceMap, BlursRowsAndColumnsAlike) {
  Image wide(24, 10), high(10, 24);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 24; ++x)
      wide.at(x, y) = high.at(y, x) = Rgbf(std::exp(0.2f * static_cast<float>(x)));
  const ImportanceMap across(wide, wide, 1), down(high, high, 1);
  for (int x = 0; x < 24; ++x)
    for (int y = 0; y < 10; ++y) {
      const float expected = across(centre(x, 24), centre(0, 10));
      EXPECT_NEAR(across(centre(x, 24), centre(y, 10)), expected, 1e-5f * expected)
          << x << " " << y;
      EXPECT_NEAR(down(centre(y, 10), centre(x, 24)), expected, 1e-5f * expected) << x << " " << y;
    }
}

TEST(ImportanceMap, MakesTheTargetEven) {
  const Image picture = ramp(64, 1);
  const ImportanceMap map(picture, picture, 1);
  // Where the picture is well above the floor, picture * map is nearly constant: within what the
  // blur and the floor leave of a factor of 55.
  float least = 1e9f, most = 0;
  for (int x = 16; x < 64; ++x) {
    const float target = luminance(picture.at(x, 0)) * map(centre(x, 64), 0.5f);
    least = std::min(least, target);
    most = std::max(most, target);
  }
  EXPECT_LT(most / least, 1.7f);
  EXPECT_GT(map(centre(2, 64), 0.5f), 4 * map(centre(60, 64), 0.5f));
}

TEST(ImportanceMap, IsContinuousAndPositive) {
  const Image picture = ramp(33, 17);
  for (const int cell : {1, 4, 40}) {
    const ImportanceMap map(picture, picture, cell);
    float last = map(0, 0.4f);
    for (int i = 1; i < 10000; ++i) {
      const float value = map(static_cast<float>(i) / 10000, 0.4f);
      EXPECT_GT(value, 0);
      EXPECT_LT(std::abs(value - last), 0.01f * std::max(value, last));
      last = value;
    }
  }
}

}  // namespace
}  // namespace h2mc
