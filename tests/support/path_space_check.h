// SPDX-License-Identifier: MIT
// What every path of a scene must satisfy: densities that are those of tracing, and a primary sample in every
// technique that leads back to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "render/core/index.h"
#include "render/path/assemble.h"
#include "render/path/path_densities.h"
#include "sampled_paths.h"

namespace h2mc::test {

// The MIS weight that the traced path's contribution has in it.
inline double tracedWeight(const Scene& scene, const Path& path) {
  const auto [s, t] = path.technique;
  const float* u = path.sample.u.data() + path.technique.lightOffset();
  const float* time = &path.sample.time;
  const TracedVertex& camera = path.camera[at(t) - 1];
  constexpr auto kBoth = Techniques::kBidirectional;
  DirectLight<float> direct;
  if (s == 0 && path.escaped) return hitEnvironment<float>(scene, path.lastRay, t, kBoth).weight;
  if (s == 0)
    return hitAreaLight<float>(scene, camera.vertex, path.lastRay.direction, path.lightIndex, t,
                               kBoth, camera.id, time)
        .weight;
  if (s == 1)
    return connectToLight<float>(scene, camera.vertex, camera.id, path.lightIndex,
                                 path.lightPrimitive, u[0], u[1], kBoth, direct, time)
        .weight;
  const TracedVertex& light = path.light[at(s) - 1];
  if (t == 1)
    return connectToCamera<float>(scene, light.vertex, light.id, time, path.sample.aperture.data())
        .weight;
  return connectVertices<float>(scene, camera.vertex, camera.id, light.vertex, light.id).weight;
}

// Counts of comparisons, and of those that were farther apart than they may be.
struct Comparison {
  long long compared = 0, apart = 0;
  double worst = 0;

  // Whether |actual - expected| <= relative * |expected| + absolute.
  bool add(double actual, double expected, double relative, double absolute) {
    const double error = std::abs(actual - expected) / (relative * std::abs(expected) + absolute);
    ++compared;
    worst = std::max(worst, error);
    const bool ok = error <= 1;  // false for NaN
    apart += !ok;
    return ok;
  }
  double rate() const { return double(apart) / double(std::max(1LL, compared)); }
};

struct DensityCheck {
  Comparison weights, targets;
  double worstSum = 0;  // of |sum of weights - 1|
};

// Densities of traced paths against the weights and the targets that tracing has given them. `alter`
// may plant a mistake in the densities.
inline DensityCheck checkDensities(
    const Scene& scene, int maxLength, int perTechnique, int samples, double tolerance,
    const std::function<void(const FullPath&, TechniqueDensities&)>& alter = {}) {
  DensityCheck check;
  FullPath full;
  forSampledPaths(scene, maxLength, perTechnique, samples, [&](const Path& path, float) {
    const int s = path.technique.s;
    if (!toFull(scene, path, full)) {
      ++check.targets.apart;
      return;
    }
    TechniqueDensities d = densities(scene, full);
    if (alter) alter(full, d);
    double sum = 0;
    for (int i = 0; i <= d.edges; ++i) sum += d.weight[at(i)];
    check.worstSum = std::max(check.worstSum, std::abs(sum - 1));
    check.weights.add(d.weight[at(s)], tracedWeight(scene, path), tolerance, tolerance * 1e-2);
    check.targets.add(d.target(s), path.target, tolerance, 0);
  });
  return check;
}

struct AssembleCheck {
  long long asked = 0;  // pairs of path and technique that can make it
  long long notAssembled = 0;
  double weightAsked = 0, weightLost = 0;  // the same as sums of MIS weights
  Comparison targets;                      // assembled against densities
  Comparison retraced;                     // tracing the sample anew: the same target as assembled
  Comparison vertices;  // .. and vertices where they were, as distance over the scene's size
};

// Takes traced paths apart and assembles them in every technique that has a share of at least
// `leastWeight` in them.
inline AssembleCheck checkAssemble(const Scene& scene, int maxLength, int perTechnique, int samples,
                                   double leastWeight, double tolerance) {
  AssembleCheck check;
  FullPath full, back;
  Path assembled(maxLength), again(maxLength);
  Random random(11, 0, 0);
  const double size = scene.bounds.radius;
  forSampledPaths(scene, maxLength, perTechnique, samples, [&](const Path& path, float) {
    if (!toFull(scene, path, full)) return;
    const TechniqueDensities d = densities(scene, full);
    for (int s = 0; s <= full.edges; ++s) {
      const double weight = d.weight[at(s)];
      if (!(weight > leastWeight)) continue;
      ++check.asked;
      check.weightAsked += weight;
      if (!assemble(scene, full, {s, full.edges + 1 - s}, kNoEdge, random, assembled)) {
        ++check.notAssembled;
        check.weightLost += weight;
        continue;
      }
      check.targets.add(assembled.target, d.target(s), tolerance, 0);
      again.technique = assembled.technique;
      again.sample = assembled.sample;
      const bool traced = tracePath(scene, again) && toFull(scene, again, back);
      check.retraced.add(traced ? again.target : 0, assembled.target, tolerance, 0);
      if (!traced) continue;
      double farthest = glm::length(Vec3f(back.filmX - full.filmX, back.filmY - full.filmY, 0));
      for (int i = full.infinite ? 1 : 0; i < full.edges; ++i) {
        const auto &a = full.x[at(i)], &b = back.x[at(i)];
        farthest = std::max(farthest, glm::length(a.point.p - b.point.p) / size);
        if (!(a.id == b.id) || a.delta != b.delta || (a.delta && !(a.lobe == b.lobe)))
          farthest = std::numeric_limits<double>::infinity();
      }
      if (full.infinite)
        farthest = std::max(farthest, double(glm::length(full.escape - back.escape)));
      check.vertices.add(farthest, 0, 0, 1e-3);
    }
  });
  return check;
}

}  // namespace h2mc::test
