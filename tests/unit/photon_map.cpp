// SPDX-License-Identifier: MIT
// The photons' grid against looking at all of them; radii; which lobes photons are gathered for.
#include "render/photon/photon_map.h"

#include <gtest/gtest.h>

#include <map>

#include "render/core/random.h"
#include "scene_files.h"

namespace h2mc {
namespace {

struct Point {
  Vec3f p;
  int number;
};
using Lists = std::vector<std::vector<Point>>;

Lists randomLists(Random& random, int count, int lists, float size) {
  Lists result(at(lists));
  for (int i = 0; i < count; ++i) {
    // Clusters, and points on coordinate planes, where cells meet.
    const float spread = random.uniform() < 0.5f ? size : size / 30;
    const auto x = [&] { return random.uniform() < 0.1f ? 0 : (random.uniform() - 0.5f) * spread; };
    result[at(static_cast<int>(random.uniform() * static_cast<float>(lists)))].push_back(
        {{x(), x(), x()}, i});
  }
  return result;
}

TEST(PointGrid, FindsWhatLiesNear) {
  Random random(1, 2, 3);
  PointGrid<Point> grid;
  // Larger and smaller than before: memory is used again.
  for (const int count : {500, 3000, 0, 1, 40}) {
    const Lists lists = randomLists(random, count, 7, 2);
    for (const float cell : {0.1f, 0.37f, 5.f}) {
      grid.build(lists, cell, 2);
      EXPECT_EQ(grid.size(), at(count));
      for (int query = 0; query < 60; ++query) {
        const Vec3f centre((random.uniform() - 0.5f) * 2, (random.uniform() - 0.5f) * 0.2f,
                           query % 2 ? 0 : (random.uniform() - 0.5f) * 2);
        const float radius = cell * (0.1f + 2 * random.uniform());
        std::map<int, int> found, near;
        grid.visit(centre, radius, [&](const Point& point, float d2) {
          EXPECT_FLOAT_EQ(d2, distance2(point.p, centre));
          ++found[point.number];
        });
        for (const auto& list : lists)
          for (const Point& point : list)
            if (distance2(point.p, centre) < radius * radius) near[point.number] = 1;
        EXPECT_EQ(found, near) << count << " points, cell " << cell << ", radius " << radius;
      }
    }
  }
}

TEST(PointGrid, HasOneOrderWhateverTheThreads) {
  Random random(4, 5, 6);
  const Lists lists = randomLists(random, 20000, 64, 1);
  std::vector<std::vector<int>> orders;
  for (const int threads : {1, 4, 2}) {
    PointGrid<Point> grid;
    grid.build(lists, 0.05f, threads);
    std::vector<int>& order = orders.emplace_back();
    grid.visit(Vec3f(0), 0.3f, [&](const Point& point, float) { order.push_back(point.number); });
  }
  EXPECT_GT(orders[0].size(), 100u);
  EXPECT_EQ(orders[1], orders[0]);
  EXPECT_EQ(orders[2], orders[0]);
}

TEST(PointGrid, FarOutAndBeyondItsCells) {
  PointGrid<Point> grid;
  const Lists lists{{{Vec3f(1e12f, 0, 0), 0}, {Vec3f(-3e15f, 2e15f, 0), 1}, {Vec3f(5, 5, 5), 2}}};
  grid.build(lists, 1e-3f, 1);
  for (const Point& point : lists[0]) {
    int found = 0;
    grid.visit(point.p, 2e-3f, [&](const Point& other, float) {
      EXPECT_EQ(other.number, point.number);
      ++found;
    });
    EXPECT_EQ(found, 1) << point.number;
  }
}

TEST(RadiusOfPass, IsTheProduct) {
  for (const double alpha : {0.1, 0.5, 2. / 3, 1.}) {
    double squared = 1;
    for (long long n = 1; n < 3000; ++n) {
      const double r = radiusOfPass(n, alpha);
      EXPECT_NEAR(r * r / squared, 1, 1e-9) << n;
      squared *= (static_cast<double>(n) + alpha) / static_cast<double>(n + 1);
    }
    // Far out, the power that it approaches.
    const double ratio = radiusOfPass(4'000'000, alpha) / radiusOfPass(1'000'000, alpha);
    EXPECT_NEAR(ratio, std::pow(4, (alpha - 1) / 2), 1e-5);
  }
}

// A rough plastic over a diffuse base: below the width of its facets all is wide, beyond only the base.
TEST(WideLobes, ShareTheScatteringWithNarrowOnes) {
  const Scene scene = testing::SceneFolder().read(testing::sceneWith(R"(
<shape type="sphere"><bsdf type="roughplastic"><float name="alpha" value="0.1"/></bsdf></shape>
<shape type="sphere"><bsdf type="dielectric"/></shape>
<shape type="sphere"><bsdf type="blendbsdf"><float name="weight" value="0.3"/>
  <bsdf type="diffuse"/><bsdf type="roughconductor"><float name="alpha" value="0.05"/></bsdf></bsdf></shape>)"));
  const auto material = [&](int shape) { return scene.shapes[at(shape)].material; };
  const WideLobes narrow(scene.bsdfs, scene.materials, 0.05f);
  const WideLobes wide(scene.bsdfs, scene.materials, 0.4f);
  EXPECT_TRUE(narrow.in(material(0)));
  EXPECT_TRUE(wide.in(material(0)));
  EXPECT_FALSE(narrow.in(material(1)));
  Random random(7, 8, 9);
  const auto direction = [&] {
    const float z = 0.05f + 0.9f * random.uniform(), phi = 2 * kPi * random.uniform();
    const float rho = std::sqrt(1 - z * z);
    return Vec3f(rho * std::cos(phi), rho * std::sin(phi), z);
  };
  const Vec2f uv(0.3f, 0.6f);
  for (const int shape : {0, 2}) {
    const Material& m = scene.materials[at(material(shape))];
    for (int i = 0; i < 200; ++i) {
      const Vec3f wi = direction(), wo = direction();
      EXPECT_EQ(narrow.share(material(shape), m, uv, wi, wo), 1);
      // What is drawn through a wide lobe, of all that is drawn.
      const float all = evaluateMaterial<float>(scene.bsdfs, m, uv, wi, wo).pdf;
      const float base =
          shape == 0 ? lobePdf<float>(scene.bsdfs, m, uv, wi, wo, {0}) : 0.7f * wo.z * kInvPi;
      const float share = wide.share(material(shape), m, uv, wi, wo);
      const float coat = shape == 0 ? lobePdf<float>(scene.bsdfs, m, uv, wi, wo, {1}) : all - base;
      const bool firstIsBase = shape != 0 || wide.isWide(m, {0});
      EXPECT_NEAR(share, (firstIsBase ? base : coat) / all, 1e-5f);
    }
  }
}

}  // namespace
}  // namespace h2mc
