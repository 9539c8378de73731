// SPDX-License-Identifier: MIT
// Densities of paths against the maps that make them: the density with which a technique makes a path is one over
// the determinant by which its map from primary coordinates stretches areas. Differences in double, on the
// frozen topology.
#include "render/path/path_densities.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exactness_scenes.h"
#include "gallery_scenes.h"
#include "render/core/index.h"
#include "render/path/assemble.h"
#include "render/path/reconnect.h"
#include "render/path/replay.h"
#include "sampled_paths.h"

namespace h2mc::test {
namespace {

constexpr int kLength = 5;
using Points = std::array<Vec3<double>, kMaxPathLength + 1>;

// x_0 .. x_(k-1) of a path's technique at coordinates u; for an infinite light the direction to it in
// place of x_0.
void pointsAt(const Scene& scene, const Path& path, bool infinite, const double* u, Points& x) {
  const auto [s, t] = path.technique;
  const int k = path.technique.length();
  const double time = path.sample.time;
  const double aperture[2] = {path.sample.aperture[0], path.sample.aperture[1]};
  PathRay<double> ray{};
  PathVertex<double> vertex{};
  for (int i = 1; i < t; ++i) {
    const double* v = u + path.technique.cameraCoordinate(i - 1);
    ray = i == 1
              ? startCamera<double>(scene, u[0], u[1], &time, aperture)
              : replayScatter<double>(scene, path, Side::kCamera, i - 1, ray, vertex, v[0], v[1]);
    if (i == t - 1 && path.escaped) {
      x[0] = ray.direction;
      return;
    }
    vertex = arriveAt<double>(scene, ray, path.camera[at(i)].id, &time);
    x[at(k - i)] = vertex.point.p;
  }
  if (s == 0) return;
  const double* l = u + path.technique.lightOffset();
  if (s == 1) {
    const DirectLight<double> direct = std::visit(
        [&](const auto& light) {
          return sampleDirectAt<double>(light, scene.lightContext(), path.lightPrimitive,
                                        vertex.point.p, l[0], l[1], &time);
        },
        scene.lights[at(path.lightIndex)]);
    x[0] = infinite ? direct.direction : direct.position;
    return;
  }
  ray = startLight<double>(scene, path.lightIndex, path.lightPrimitive, l[0], l[1], l[2], l[3],
                           &time);
  x[0] = infinite ? -ray.direction : ray.origin;
  for (int i = 1; i < s; ++i) {
    const double* v = u + path.technique.lightCoordinate(i - 1);
    if (i > 1)
      ray = replayScatter<double>(scene, path, Side::kLight, i - 1, ray, vertex, v[0], v[1]);
    vertex = arriveAt<double>(scene, ray, path.light[at(i)].id, &time);
    x[at(i)] = vertex.point.p;
  }
}

// log |determinant|; -inf where it vanishes.
double logDeterminant(std::vector<std::vector<double>> m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < m.size(); ++r)
      if (std::abs(m[r][i]) > std::abs(m[pivot][i])) pivot = r;
    std::swap(m[i], m[pivot]);
    sum += std::log(std::abs(m[i][i]));
    for (std::size_t r = i + 1; r < m.size(); ++r) {
      const double factor = m[r][i] / m[i][i];
      for (std::size_t c = i; c < m.size(); ++c) m[r][c] -= factor * m[i][c];
    }
  }
  return sum;
}

// Which coordinates place or turn something: not those of delta lobes, nor those that delta lights ignore.
std::vector<int> usedCoordinates(const Scene& scene, const Path& path) {
  const auto [s, t] = path.technique;
  std::vector<int> used;
  const auto use = [&](int k) { used.insert(used.end(), {k, k + 1}); };
  const auto delta = [&](const TracedVertex& v) {
    return isDelta(scene.bsdfs, materialAt(scene, v.id), v.lobe);
  };
  if (t >= 2) use(0);
  for (int i = 1; i <= t - 2; ++i)
    if (!delta(path.camera[at(i)])) use(path.technique.cameraCoordinate(i));
  if (s >= 1) {
    const Light& light = scene.lights[at(path.lightIndex)];
    const bool deltaLight = std::visit([](const auto& l) { return l.isDelta(); }, light);
    const bool infinite = std::visit([](const auto& l) { return l.isInfinite(); }, light);
    const int offset = path.technique.lightOffset();
    if (!deltaLight || (infinite && s >= 2)) use(offset);
    if (s >= 2 && !(deltaLight && infinite)) use(offset + 2);
  }
  for (int i = 1; i <= s - 2; ++i)
    if (!delta(path.light[at(i)])) use(path.technique.lightCoordinate(i));
  return used;
}

// log of (density of the path and of its lobes and choices) * |d areas / d coordinates|: 0 where the
// density is right. NaN where the map has no derivative to speak of.
double logProduct(const Scene& scene, const Path& path, const FullPath& full,
                  const TechniqueDensities& d) {
  const int s = path.technique.s, k = full.edges;
  double u[2 * kMaxPathLength];
  std::copy_n(path.sample.u.begin(), path.technique.dimension(), u);
  const std::vector<int> used = usedCoordinates(scene, path);
  // Two directions along each surface (or across the direction of an infinite light).
  std::vector<std::pair<int, Vec3<double>>> axes;
  const Light& light = scene.lights[at(full.light)];
  const bool deltaLight = std::visit([](const auto& l) { return l.isDelta(); }, light);
  for (int i = deltaLight ? 1 : 0; i < k; ++i) {
    const FullVertex& v = full.x[at(i)];
    if (v.delta) continue;
    const Vec3f normal = i == 0 && full.infinite ? full.escape : v.point.ng;
    const auto frame = Frame<double>::fromNormal(normalize(Vec3<double>(normal)));
    axes.push_back({i, frame.s});
    axes.push_back({i, frame.t});
  }
  EXPECT_EQ(axes.size(), used.size());
  if (axes.size() != used.size()) return NAN;
  std::vector<std::vector<double>> jacobian(axes.size(), std::vector<double>(axes.size()));
  constexpr double kStep = 1e-6;
  for (std::size_t c = 0; c < used.size(); ++c) {
    double& x = u[used[c]];
    const double kept = x;
    if (!(x > 4e-3 && x < 1 - 4e-3)) return NAN;
    Points above, below;
    x = kept + kStep;
    pointsAt(scene, path, full.infinite, u, above);
    x = kept - kStep;
    pointsAt(scene, path, full.infinite, u, below);
    x = kept;
    for (std::size_t r = 0; r < axes.size(); ++r) {
      const auto i = at(axes[r].first);
      jacobian[r][c] = dot(above[i] - below[i], axes[r].second) / (2 * kStep);
    }
  }
  double choices = logLobeDensity(scene, path);
  if (s >= 1) {
    choices -=
        std::log((s == 1 ? scene.directPicker : scene.emissionPicker).probability(full.light));
    if (const auto* area = std::get_if<AreaLight>(&light)) {
      const Shape& shape = scene.shapes[at(area->shape)];
      choices -= std::log(primitiveArea(shape, full.lightPrimitive.primitive) / totalArea(shape));
    }
  }
  return d.logDensity[at(s)] + choices + logDeterminant(std::move(jacobian));
}

// Comparisons to 1 %.
struct Count {
  int paths = 0, apart = 0;
  void add(double error) {
    ++paths;
    apart += !(std::abs(error) <= 1e-2);
  }
};

class DensityJacobian : public ::testing::TestWithParam<std::string> {
 protected:
  Scene scene() {
    const std::string moving = halfMovingScene(0, 1, true);
    return GetParam() == "motion"     ? folder_.read(moving)
           : GetParam() == "parallel" ? folder_.read(seenInParallel(skyScene(), 1.4))
           : GetParam() == "lens"     ? folder_.read(withThinLens(moving, 0.2, 6))
                                  : galleryScene(folder_, galleryLights(folder_).at(GetParam()));
  }
  testing::SceneFolder folder_;
};

// Without delta vertices mu is the product of areas. With them the product has a factor of its own, the same for
// all of a path's techniques: those are compared with the first that is not NaN.
TEST_P(DensityJacobian, IsOneOverTheDensity) {
  const Scene scene = this->scene();
  Count plain, refracted, mistaken;
  FullPath full;
  Path other(kLength);
  Random random(4, 0, 0);
  forSampledPaths(scene, kLength, 100, 12000, [&](const Path& path, float) {
    if (!toFull(scene, path, full)) return;
    const TechniqueDensities d = densities(scene, full);
    bool delta = false;
    for (int i = 1; i < full.edges; ++i) delta |= full.x[at(i)].delta;
    const double own = logProduct(scene, path, full, d);
    if (std::isnan(own)) return;
    if (!delta) {
      plain.add(own);
      return;
    }
    for (int s = 0; s <= full.edges; ++s) {
      if (s == path.technique.s || !(d.weight[at(s)] > 1e-4)) continue;
      if (!assemble(scene, full, {s, full.edges + 1 - s}, kNoEdge, random, other)) continue;
      const double theirs = logProduct(scene, other, full, d);
      if (std::isnan(theirs)) continue;
      refracted.add(theirs - own);
      // With what MIS weights reckon as density: as if refraction kept solid angles.
      const auto reckoned = [&](int i) {
        return std::log(d.weight[at(i)]) / 2 - d.logDensity[at(i)];
      };
      mistaken.add(theirs - own + reckoned(s) - reckoned(path.technique.s));
    }
  });
  std::printf(
      "%d paths without delta vertices, %d apart; %d pairs of techniques with, %d apart; "
      "%d if refraction is left out\n",
      plain.paths, plain.apart, refracted.paths, refracted.apart, mistaken.apart);
  EXPECT_GT(plain.paths, 200);
  EXPECT_LE(plain.apart, plain.paths / 100);
  EXPECT_GT(refracted.paths, 20);
  EXPECT_LE(refracted.apart, 1 + refracted.paths / 100);
  // Balls of glass turn back what they have turned; those with shading normals do not. The other scenes have none.
  if (GetParam() != "motion" && GetParam() != "lens" && GetParam() != "parallel") {
    EXPECT_GT(mistaken.apart, 3 + 3 * refracted.apart);
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, DensityJacobian,
                         ::testing::Values("area", "points", "infinite", "sky", "motion", "lens",
                                           "parallel"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace h2mc::test
