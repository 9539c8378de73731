// SPDX-License-Identifier: MIT
// The gradient alone against the gradient in double, for paths of every technique and length.
#include "render/path/gradient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image_check.h"
#include "render/path/replay_double.h"
#include "sampled_paths.h"

namespace h2mc {
namespace {

class Gradients : public ::testing::TestWithParam<const char*> {};

TEST_P(Gradients, AreThoseOfDouble) {
  constexpr int kLongest = 10;  // more coordinates than are done at once
  const Scene scene = test::readTestScene(std::string(H2MC_SOURCE_DIR "/scenes/") + GetParam());
  int checked = 0, withTime = 0, large = 0, off = 0, wrong = 0;
  test::forSampledPaths(scene, kLongest, 12, 20000, [&](const Path& path, float) {
    double u[kMaxCoordinates];
    pathCoordinates(path, u);
    const auto expected = differentiateInDouble(scene, path, u);
    if (!expected.finite()) return;
    Gradient found;
    differentiateOnce(scene, path, found);
    ASSERT_EQ(found.dimension, path.dimension());
    double difference = 0, largest = 1;
    for (int i = 0; i < found.dimension; ++i) {
      largest = std::max(largest, std::abs(expected.gradient[at(i)]));
      difference = std::max(difference, std::abs(found.gradient[i] - expected.gradient[at(i)]));
    }
    ++checked;
    withTime += path.moving;
    large += found.dimension > 16;
    off += !(difference <= 1e-2 * largest);
    wrong += !(difference <= 0.2 * largest);
  });
  std::printf("%d paths, %d with time, %d of more than 16 coordinates; %d off, %d of them wrong\n",
              checked, withTime, large, off, wrong);
  EXPECT_GT(checked, 200);
  EXPECT_GT(large, 15);
  // Float loses digits along paths that graze something smooth; steps only need a rough idea there.
  EXPECT_LE(off, checked / 12);
  EXPECT_LE(wrong, checked / 40);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Gradients,
                         ::testing::Values("ring/ring.xml", "cars/cars.xml", "pool/pool.xml"));

}  // namespace
}  // namespace h2mc
