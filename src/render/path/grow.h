// SPDX-License-Identifier: MIT
// Full paths made vertex by vertex, as tracing makes subpaths: by rays from either end. Indices are those of the full
// path: on the camera's side x_(i-1) follows x_i, on the light's x_(i+1).
#pragma once

#include "render/path/full_path.h"
#include "render/path/reconnect.h"

namespace h2mc {

// A ray of the camera's or a light's side, and what it finds.
struct Growth {
  const Scene& scene;
  FullPath& path;

  // x_(k-1) by a ray through a point of the film. False where it finds nothing; true where that is the
  // environment and k = 1. Precondition: path.edges, path.time and the eye are set.
  bool leaveEye(float filmX, float filmY);
  // The vertex after x_i, by a ray from it along unit `direction`. False where it finds nothing, but for an environment
  // as x_0 of the camera's side. Whether what is found emits is left to setLightHit.
  bool leave(int i, Side side, const Vec3f& direction);
  // x_1 by a ray that comes from the light at x_0.
  bool arriveFromLight(const PathRay<float>& ray);

  // The direction in which the coordinates of `sample` scatter at x_i what arrives there on this side's way; sets
  // its delta lobe, or that it has none. False where nothing goes that way.
  bool scatter(int i, Side side, const ScatterSample& sample, Vec3f& direction);
};

inline ScatterSample uniformSample(Random& random) {
  ScatterSample sample;
  sample.u.x = random.uniform();
  sample.u.y = random.uniform();
  sample.choice = random.uniform();
  return sample;
}

// The coordinates with which x_i scatters as the path goes on from it on this side's way, 0 < i < k: see
// invertScattering and invertDelta. False where that side does not make it.
bool scatterSample(const Scene& scene, const FullPath& path, int i, Side side, Random& random,
                   ScatterSample& sample);

// Whether x_i, 0 <= i < k, is where a path may be joined: an end on a light, or a surface whose widest lobe, seen from
// the camera's side, is at least `threshold` radians wide, unless the path goes on through a delta lobe.
bool joinable(const Scene& scene, const FullPath& path, int i, float threshold);
// The same of the full path that toFull makes of `path`.
bool joinable(const Scene& scene, const Path& path, int i, float threshold);

// The probability with which a path from the camera goes on from x_i through a lobe that is no delta lobe.
double nonDeltaProbability(const Scene& scene, const FullPath& path, int i);

}  // namespace h2mc
