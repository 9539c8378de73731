// SPDX-License-Identifier: MIT
// The picture as a target, and the chains that copy it.
#include "demo/image_copy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/image/metrics.h"

namespace h2mc {
namespace {

// A slanted ridge on a floor, coloured.
Image picture(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double across = (x - 0.6 * y - 0.3 * width) / (0.08 * width);
      const float v = static_cast<float>(0.05 + std::exp(-0.5 * across * across));
      image.at(x, y) = Rgbf(v, 0.6f * v + 0.1f, 0.02f * static_cast<float>(y));
    }
  return image;
}

TEST(PictureTarget, DerivativesAgreeWithFiniteDifferences) {
  const PictureTarget target(picture(24, 18));
  const auto log = [&](double x, double y) {
    return std::log(
        static_cast<double>(luminance(target.color(static_cast<float>(x), static_cast<float>(y)))));
  };
  Random random(5, 6, 7);
  for (int i = 0; i < 200; ++i) {
    const float x = random.uniform(), y = random.uniform();
    Derivative d;
    target.differentiate(x, y, d);
    ASSERT_TRUE(d.finite());
    EXPECT_NEAR(d.logTarget, log(x, y), 1e-5);
    // In float, so the steps are long; a spline's piece is 1 / 24.
    const double h = 1.0 / 256;
    const double gx = (log(x + h, y) - log(x - h, y)) / (2 * h);
    const double gy = (log(x, y + h) - log(x, y - h)) / (2 * h);
    EXPECT_NEAR(d.gradient[0], gx, 0.03 * std::abs(gx) + 1) << x << " " << y;
    EXPECT_NEAR(d.gradient[1], gy, 0.03 * std::abs(gy) + 1) << x << " " << y;
    Derivative right, below;
    target.differentiate(x + static_cast<float>(h), y, right);
    target.differentiate(x, y + static_cast<float>(h), below);
    EXPECT_NEAR(d.hessian[0], (right.gradient[0] - d.gradient[0]) / h, 250);
    EXPECT_NEAR(d.hessian[1], (right.gradient[1] - d.gradient[1]) / h, 250);
    EXPECT_NEAR(d.hessian[2], (below.gradient[1] - d.gradient[1]) / h, 250);
  }
}

// Whatever proposes, the copy tends to the picture; its error falls as the number of mutations grows.
TEST(CopyChain, ConvergesWithEveryKernel) {
  const PictureTarget target(picture(12, 9));
  const Image reference = target.pixelMeans();
  const auto error = [&](const CopyChain& chain) {
    return findMetric("relmse")->compute(chain.copy(), reference);
  };
  for (const CopyKernel& kernel :
       {CopyKernel{"small", "", 0, 0.1f, false}, CopyKernel{"large", "", 1, 0.1f, false},
        CopyKernel{"mixed", "", 0.2, 0.1f, false}, CopyKernel{"hamiltonian", "", 0, 0.2f, true},
        CopyKernel{"both", "", 0.2, 0.2f, true}}) {
    CopyChain chain(target, kernel, 3);
    chain.run(20 * 108);
    const double early = error(chain);
    chain.run(4000 * 108);
    EXPECT_LT(error(chain), 0.002) << kernel.name;
    EXPECT_LT(error(chain), 0.1 * early) << kernel.name;
    EXPECT_GT(chain.acceptance(), 0.1) << kernel.name;
    EXPECT_EQ(chain.walk().size(), 600u);
  }
}

TEST(CopyChain, SmallStepsAreAcceptedMoreOftenThanLongOnes) {
  const PictureTarget target(picture(48, 36));
  double before = 1.01;
  for (const float sigma : {0.002f, 0.02f, 0.2f}) {
    CopyChain chain(target, {"", "", 0.2, sigma, false}, 1);
    chain.run(40000);
    EXPECT_LT(chain.acceptance(), before);
    before = chain.acceptance();
  }
}

TEST(Shrunk, KeepsTheMean) {
  const Image image = picture(50, 31);
  const Image small = shrunk(image, 12);
  EXPECT_EQ(small.width, 12);
  EXPECT_EQ(small.height, 7);
  EXPECT_NEAR(meanLuminance(small), meanLuminance(image), 1e-5);
  EXPECT_EQ(shrunk(image, 50).width, 50);
}

}  // namespace
}  // namespace h2mc
