// SPDX-License-Identifier: MIT
// Bidirectional samples around a path that is given.
#include "render/path/bidirectional.h"

#include <gtest/gtest.h>

#include "exactness_scenes.h"
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

// Coordinates by their places: each is drawn when it is asked for the first time.
class Remembered final : public SampleCoordinates {
 public:
  Remembered(int places, std::uint64_t seed) : values_(at(places), -1), random_(seed, 0, 0) {}
  float read(int place) override {
    float& value = values_[at(place)];
    if (value < 0) value = random_.uniform();
    return value;
  }
  void set(int place, float value) override { values_[at(place)] = value; }

 private:
  std::vector<float> values_;
  Random random_;
};

void expectEqual(const std::vector<BidirectionalSampler::Connection>& actual,
                 const std::vector<BidirectionalSampler::Connection>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].technique, expected[i].technique);
    EXPECT_EQ(actual[i].contribution, expected[i].contribution);
    EXPECT_EQ(actual[i].filmX, expected[i].filmX);
    EXPECT_EQ(actual[i].filmY, expected[i].filmY);
  }
}

class AtCoordinates : public ::testing::TestWithParam<ExactnessScene> {
 protected:
  using Connections = std::vector<BidirectionalSampler::Connection>;
  testing::SceneFolder folder_;
  Scene scene_ = folder_.read(GetParam().xml);
  BidirectionalSampler sampler_{GetParam().maxLength};
};

// The sample that lies at a place has the connections that it had when it was drawn, and so has the one that is
// completed around one of these.
TEST_P(AtCoordinates, IsTheSampleThere) {
  const auto into = [](Connections& list) {
    return [&](const BidirectionalSampler::Connection& c) { list.push_back(c); };
  };
  Path path(GetParam().maxLength);
  std::size_t seen = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    Remembered coordinates(sampler_.places(), i);
    Random random(i, 0, 0);
    Connections drawn, again, around, byStream;
    sampler_.sample(scene_, coordinates, 1, into(drawn));
    sampler_.sample(scene_, coordinates, 1, into(again));
    expectEqual(again, drawn);
    sampler_.sample(scene_, random, -1, -1, 1, into(byStream));
    expectEqual(byStream, drawn);
    seen += drawn.size();
    if (drawn.empty()) continue;
    const auto& chosen = drawn[i % drawn.size()];
    path.technique = chosen.technique;
    path.sample = sampler_.primarySample(chosen.technique);
    ASSERT_TRUE(tracePath(scene_, path));
    Remembered others(sampler_.places(), 1000 + i);
    sampler_.complete(scene_, others, path, 1, into(around));
    again.clear();
    sampler_.sample(scene_, others, 1, into(again));
    expectEqual(again, around);
  }
  EXPECT_GT(seen, 500u);
}

// A connection as a path is what tracing gives.
TEST_P(AtCoordinates, IsMadeOfPathsAsTraced) {
  Path path(GetParam().maxLength), traced(GetParam().maxLength);
  int paths = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Remembered coordinates(sampler_.places(), i);
    Connections drawn;
    sampler_.sample(scene_, coordinates, 1,
                    [&](const BidirectionalSampler::Connection& c) { drawn.push_back(c); });
    for (const auto& c : drawn) {
      ASSERT_TRUE(sampler_.path(scene_, c.technique, path));
      EXPECT_EQ(path.contribution, c.contribution);
      EXPECT_EQ(path.filmX, c.filmX);
      EXPECT_EQ(path.filmY, c.filmY);
      traced.technique = c.technique;
      traced.sample = path.sample;
      ASSERT_TRUE(tracePath(scene_, traced));
      EXPECT_EQ(traced.contribution, path.contribution);
      EXPECT_EQ(traced.target, path.target);
      EXPECT_EQ(traced.filmX, path.filmX);
      EXPECT_EQ(traced.filmY, path.filmY);
      EXPECT_EQ(traced.wraps, path.wraps);
      EXPECT_EQ(traced.moving, path.moving);
      EXPECT_EQ(traced.aperture, path.aperture);
      EXPECT_EQ(traced.escaped, path.escaped);
      if (path.escaped) {
        EXPECT_EQ(traced.lastRay.direction, path.lastRay.direction);
      }
      EXPECT_EQ(traced.lightIndex, path.lightIndex);
      const auto [s, t] = c.technique;
      if (s >= 1) {
        EXPECT_EQ(traced.lightPrimitive, path.lightPrimitive);
      }
      const auto expectSame = [](const TracedVertex& a, const TracedVertex& b, bool last) {
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.vertex.point.p, b.vertex.point.p);
        if (!last) {
          EXPECT_EQ(a.lobe, b.lobe);
        }
      };
      for (int k = 1; k < t - path.escaped; ++k)
        expectSame(traced.camera[at(k)], path.camera[at(k)], k == t - 1);
      for (int k = 1; k < s; ++k) expectSame(traced.light[at(k)], path.light[at(k)], k == s - 1);
      ++paths;
    }
  }
  EXPECT_GT(paths, 1000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AtCoordinates, ::testing::ValuesIn(exactnessScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc::test
