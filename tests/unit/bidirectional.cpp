// SPDX-License-Identifier: MIT
// Bidirectional samples around a path that is given.
#include "render/path/bidirectional.h"

#include <gtest/gtest.h>

#include "motion_scenes.h"
#include "render/core/index.h"
#include "sampled_paths.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

constexpr int kLength = 5;

class Complete : public ::testing::Test {
 protected:
  using Connection = BidirectionalSampler::Connection;

  std::vector<Connection> complete(const Path& given) {
    std::vector<Connection> connections;
    Random random(8, 0, 0);
    sampler_.complete(scene_, random, given, 1,
                      [&](const Connection& c) { connections.push_back(c); });
    return connections;
  }
  testing::SceneFolder folder_;
  Scene scene_ = folder_.read(halfMovingScene(0, 1, true));
  BidirectionalSampler sampler_{kLength};
};

TEST_F(Complete, HasTheGivenPath) {
  int paths = 0, others = 0;
  forSampledPaths(scene_, kLength, 100, 3000, [&](const Path& given, float) {
    int found = 0;
    for (const Connection& c : complete(given)) {
      others += c.technique != given.technique;
      if (c.technique != given.technique) continue;
      ++found;
      EXPECT_EQ(c.contribution, given.contribution);
      EXPECT_EQ(c.filmX, given.filmX);
      EXPECT_EQ(c.filmY, given.filmY);
    }
    EXPECT_EQ(found, 1);
    ++paths;
  });
  EXPECT_GT(paths, 500);
  EXPECT_GT(others, paths);
}

// A path whose vertices came first has a primary sample that leads to them but for rounding, which may
// be anywhere: here it does lead elsewhere.
TEST_F(Complete, TakesVerticesNotTheSampleTheyCameFrom) {
  int paths = 0;
  forSampledPaths(scene_, kLength, 100, 3000, [&](const Path& given, float) {
    Path moved = given;
    for (int i = given.technique.t >= 2 ? 2 : 0; i < given.technique.dimension(); ++i)
      moved.sample.u[at(i)] = wrap(moved.sample.u[at(i)] + 0.3f);
    for (float& choice : moved.sample.choice) choice = wrap(choice + 0.5f);
    const auto expected = complete(given), actual = complete(moved);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      EXPECT_EQ(actual[i].technique, expected[i].technique);
      EXPECT_EQ(actual[i].contribution, expected[i].contribution);
    }
    ++paths;
  });
  EXPECT_GT(paths, 500);
}

}  // namespace
}  // namespace h2mc::test
