// SPDX-License-Identifier: MIT
// Image metrics against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/image/metrics.h"

namespace h2mc {
namespace {

Image constant(int width, int height, const Rgbf& color) {
  Image image(width, height);
  for (Rgbf& p : image.pixels) p = color;
  return image;
}

double metric(const char* name, const Image& image, const Image& reference) {
  const Metric* found = findMetric(name);
  if (!found) ADD_FAILURE() << name;
  return found ? found->compute(image, reference) : 0;
}

TEST(Metrics, AreFoundByName) {
  for (const Metric& m : metrics()) EXPECT_EQ(findMetric(m.name), &m);
  EXPECT_EQ(findMetric("relmsee"), nullptr);
}

TEST(Metrics, OfAConstantError) {
  const Image reference = constant(10, 10, Rgbf(2)), image = constant(10, 10, Rgbf(2.5f));
  EXPECT_NEAR(metric("mse", image, reference), 0.25, 1e-9);
  EXPECT_NEAR(metric("rmse", image, reference), 0.5, 1e-9);
  EXPECT_NEAR(metric("mae", image, reference), 0.5, 1e-9);
  EXPECT_NEAR(metric("relmse", image, reference), 0.25 / (4 + 0.01 * 4), 1e-9);
  EXPECT_NEAR(metric("relmse-trimmed", image, reference), 0.25 / (4 + 0.01 * 4), 1e-9);
  EXPECT_NEAR(metric("mape", image, reference), 0.5 / (2 + 0.01 * 2), 1e-9);
  EXPECT_NEAR(metric("smape", image, reference), 2 * 0.5 / 4.5, 1e-9);
  EXPECT_NEAR(metric("psnr", image, reference), 10 * std::log10(4 / 0.25), 1e-9);
}

// One channel off: the others share the mean.
TEST(Metrics, AverageOverChannels) {
  const Image reference = constant(4, 4, Rgbf(1, 2, 3)), image = constant(4, 4, Rgbf(1, 2, 4));
  const double m = 0.212671 + 2 * 0.715160 + 3 * 0.072169;
  EXPECT_NEAR(meanLuminance(reference), m, 1e-6);
  EXPECT_NEAR(metric("mse", image, reference), 1 / 3.0, 1e-9);
  EXPECT_NEAR(metric("relmse", image, reference), 1 / (9 + 0.01 * m * m) / 3, 1e-9);
  EXPECT_NEAR(metric("smape", image, reference), 2 / 7.0 / 3, 1e-9);
}

TEST(Metrics, OfTheSameImage) {
  for (const Image& image : {constant(3, 3, Rgbf(0.5f)), constant(3, 3, Rgbf(0))})
    for (const Metric& m : metrics()) {
      if (m.higherIsBetter) continue;
      EXPECT_EQ(m.compute(image, image), 0) << m.name;
    }
  const Image image = constant(3, 3, Rgbf(0.5f));
  EXPECT_EQ(metric("psnr", image, image), std::numeric_limits<double>::infinity());
}

TEST(Metrics, TrimmingLeavesOutTheWorstPixels) {
  const Image reference = constant(50, 40, Rgbf(1));  // 2,000 pixels, two of them left out
  Image image = constant(50, 40, Rgbf(1.1f));
  image.at(7, 9) = Rgbf(1000);
  image.at(8, 9) = Rgbf(500);
  const double e = 0.01 / 1.01;
  EXPECT_NEAR(metric("relmse-trimmed", image, reference), e, 1e-6);
  EXPECT_GT(metric("relmse", image, reference), 100);
  image.at(9, 9) = Rgbf(2);  // a third one stays in
  EXPECT_NEAR(metric("relmse-trimmed", image, reference), (1997 * e + 1 / 1.01) / 1998, 1e-6);
}

TEST(Metrics, NothingFiniteHidesABadPixel) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image reference = constant(40, 40, Rgbf(1));
  Image image = reference;
  image.at(1, 1) = Rgbf(0, nan, 0);
  for (const Metric& m : metrics()) EXPECT_TRUE(std::isnan(m.compute(image, reference))) << m.name;
  for (const Metric& m : metrics()) EXPECT_TRUE(std::isnan(m.compute(reference, image))) << m.name;
  EXPECT_EQ(countNonFinite(image), 1);
  EXPECT_EQ(countNonFinite(reference), 0);
}

TEST(Metrics, DifferencePicture) {
  const Image reference = constant(4, 1, Rgbf(1));
  Image image = reference;
  image.at(1, 0) = Rgbf(1.5f);
  image.at(2, 0) = Rgbf(0.5f);
  image.at(3, 0) = Rgbf(std::numeric_limits<float>::infinity());
  const Image picture = differencePicture(image, reference, DifferencePicture::kSigned);
  EXPECT_EQ(picture.at(0, 0), Rgbf(0));
  EXPECT_GT(picture.at(1, 0).x, 0.5f);
  EXPECT_EQ(picture.at(1, 0).z, 0);
  EXPECT_GT(picture.at(2, 0).z, 0.5f);
  EXPECT_EQ(picture.at(2, 0).x, 0);
  EXPECT_EQ(picture.at(3, 0), Rgbf(1, 0, 1));

  const Image heat = differencePicture(image, reference, DifferencePicture::kRelative);
  EXPECT_LT(heat.at(0, 0).x, heat.at(1, 0).x);
  EXPECT_EQ(heat.at(3, 0), Rgbf(1, 0, 1));
}

}  // namespace
}  // namespace h2mc
