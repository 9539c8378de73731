// SPDX-License-Identifier: MIT
// Full paths made vertex by vertex.
#include "render/path/grow.h"

#include <gtest/gtest.h>

#include "exactness_scenes.h"
#include "render/core/index.h"
#include "render/path/assemble.h"
#include "render/path/path_densities.h"
#include "sampled_paths.h"

namespace h2mc::test {
namespace {

// How far a vertex is from where it was, in sizes of the scene; 1 where it is another one.
double distance(const Scene& scene, const FullPath& a, const FullPath& b, int i) {
  if (i == 0 && a.infinite) return b.infinite ? glm::length(a.escape - b.escape) : 1;
  const FullVertex &v = a.x[at(i)], &w = b.x[at(i)];
  return v.id == w.id ? glm::length(v.point.p - w.point.p) / scene.bounds.radius : 1;
}

struct Regrowth {
  long long paths = 0, missed = 0, apart = 0;
};

// Makes every path again from the coordinates that it has on one side, by rays.
Regrowth regrow(const Scene& scene, int maxLength, Side side) {
  Regrowth result;
  FullPath x, y;
  Random random(3, 0, 0);
  forSampledPaths(scene, maxLength, 300, 20000, [&](const Path& path, float) {
    if (!toFull(scene, path, x)) return;
    const TechniqueDensities d = densities(scene, x);
    const int k = x.edges;
    if (!(d.weight[at(side == Side::kCamera ? 0 : k)] > 0.01)) return;
    ++result.paths;
    y = x;
    Growth growth{scene, y};
    ScatterSample sample;
    Vec3f direction;
    const auto next = [&](int i) {
      return scatterSample(scene, x, i, side, random, sample) &&
             growth.scatter(i, side, sample, direction) && growth.leave(i, side, direction);
    };
    bool grown = true;
    if (side == Side::kCamera) {
      for (int i = 0; i < k; ++i) y.x[at(i)].id = {};
      grown = growth.leaveEye(x.filmX, x.filmY);
      for (int i = k - 1; grown && i >= 1; --i) grown = next(i);
      grown = grown && setLightHit(scene, y) && y.light == x.light &&
              y.lightPrimitive == x.lightPrimitive;
    } else {
      for (int i = 2; i < k; ++i) y.x[at(i)].id = {};
      for (int i = 1; grown && i <= k - 2; ++i) grown = next(i);
    }
    result.missed += !grown;
    double farthest = 0;
    for (int i = 0; grown && i < k; ++i) {
      farthest = std::max(farthest, distance(scene, x, y, i));
      if (x.x[at(i)].delta != y.x[at(i)].delta ||
          (x.x[at(i)].delta && !(x.x[at(i)].lobe == y.x[at(i)].lobe)))
        farthest = 1;
    }
    result.apart += farthest > 1e-3;
  });
  return result;
}

// Of paths that the side has a share of; the others are in the far tails of lobes, where coordinates have no digits
// left. Rounding turns a direction a little, which moves what is seen at grazing angles: up to 5 of 1000.
TEST(Grow, MakesThePathAgainFromEitherEnd) {
  for (const ExactnessScene& of : exactnessScenes()) {
    testing::SceneFolder folder;
    const Scene scene = folder.read(of.xml);
    for (const Side side : {Side::kCamera, Side::kLight}) {
      const Regrowth r = regrow(scene, of.maxLength, side);
      std::printf("%s: %lld paths, %lld missed, %lld apart\n", of.name, r.paths, r.missed, r.apart);
      EXPECT_GT(r.paths, 10) << of.name;
      EXPECT_LE(double(r.missed + r.apart), 5e-3 * double(r.paths)) << of.name;
    }
  }
}

TEST(Grow, JoinsAPathWhereItJoinsTheFullPath) {
  long long joinables = 0, others = 0;
  for (const ExactnessScene& of : exactnessScenes()) {
    testing::SceneFolder folder;
    const Scene scene = folder.read(of.xml);
    FullPath full;
    forSampledPaths(scene, of.maxLength, 300, 20000, [&](const Path& path, float) {
      if (!toFull(scene, path, full)) return;
      for (int i = 0; i < full.edges; ++i) {
        const bool joined = joinable(scene, full, i, 0.1f);
        ++(joined ? joinables : others);
        EXPECT_EQ(joined, joinable(scene, path, i, 0.1f)) << of.name << " vertex " << i;
      }
    });
  }
  EXPECT_GT(joinables, 1000);
  EXPECT_GT(others, 1000);
}

// The densities of both sides add up to a technique's, and by themselves are those of its parts.
TEST(TechniqueDensities, AreMadeOfBothSides) {
  for (const ExactnessScene& of : exactnessScenes()) {
    testing::SceneFolder folder;
    const Scene scene = folder.read(of.xml);
    FullPath full;
    forSampledPaths(scene, of.maxLength, 100, 5000, [&](const Path& path, float) {
      if (!toFull(scene, path, full)) return;
      const TechniqueDensities d = densities(scene, full);
      for (int s = 0; s <= d.edges; ++s) {
        if (!std::isfinite(d.logDensity[at(s)])) continue;
        EXPECT_NEAR(d.fromCamera[at(s)] + d.fromLight[at(s)], d.logDensity[at(s)], 1e-9);
      }
      EXPECT_EQ(d.fromCamera[at(d.edges)], 0);
      EXPECT_EQ(d.fromLight[0], 0);
    });
  }
}

// What the camera looks away from is not seen, and no ray is cast backwards.
TEST(EdgeVisible, IsFalseForASkyBehindTheCamera) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(glassScene());
  FullPath path;
  path.edges = 1;
  path.infinite = true;
  path.light = scene.environment;
  path.x[1].point.p = scene.camera.position();
  path.escape = -scene.camera.forward();
  EXPECT_FALSE(edgeVisible(scene, path, 1));
  path.escape = glm::normalize(scene.camera.forward() + Vec3f(0, 0.2f, 0));
  EXPECT_TRUE(edgeVisible(scene, path, 1));
}

}  // namespace
}  // namespace h2mc::test
