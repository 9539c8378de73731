// SPDX-License-Identifier: MIT
#include "render/path/lens_replay.h"

#include "ad/dual.h"
#include "render/core/index.h"
#include "render/path/replay.h"

namespace h2mc {
namespace {

using T = ad::Dual2<float, 2>;

Vec3<T> constant(const Vec3f& a) { return {T(a.x), T(a.y), T(a.z)}; }

SurfacePoint<T> constant(const SurfacePoint<float>& a) {
  SurfacePoint<T> b;
  b.p = constant(a.p);
  b.ng = constant(a.ng);
  b.shading.assign(a.shading);
  b.flat = a.flat;
  b.constantNormal = true;
  b.bend = a.bend;
  b.unbent = a.unbent;
  b.uv = {T(a.uv.x), T(a.uv.y)};
  return b;
}

PathVertex<T> constant(const PathVertex<float>& a) {
  PathVertex<T> b;
  b.point = constant(a.point);
  b.wi = constant(a.wi);
  b.cosIn = T(a.cosIn);
  b.throughput = constant(a.throughput);
  b.vcm = T(a.vcm);
  b.vc = T(a.vc);
  return b;
}

// The direction from camera vertex i, which is `here`, to the one after it, which stays.
Vec3<T> towardsNext(const Path& path, int i, const Vec3<T>& here) {
  if (path.escaped && i + 1 == path.technique.t - 1) return constant(path.lastRay.direction);
  const Vec3<T> edge = constant(path.camera[at(i) + 1].vertex.point.p) - here;
  return edge * (T(1) / sqrt(length2(edge)));
}

}  // namespace

void differentiateLens(const Scene& scene, const Path& path, int reconnection, Derivative& result) {
  const Technique technique = path.technique;
  const int last = technique.t - 1;
  const float* u = path.sample.u.data();
  const T time(path.sample.time);
  const T aperture[2] = {T(path.sample.aperture[0]), T(path.sample.aperture[1])};
  PathRay<T> ray =
      startCamera<T>(scene, T::variable(u[0], 0), T::variable(u[1], 1), &time, aperture);
  PathVertex<T> camera{}, light{};
  T logDensity(0);  // of the vertices whose sampling the film position changes, per area
  for (int i = 1; i <= last; ++i) {
    const TracedVertex& traced = path.camera[at(i)];
    const bool stays = i > reconnection;
    if (i > 1) {
      const TracedVertex& previous = path.camera[at(i) - 1];
      const int k = technique.cameraCoordinate(i - 1);
      if (!stays) {
        ray =
            replayScatter<T>(scene, path, Side::kCamera, i - 1, ray, camera, T(u[k]), T(u[k + 1]));
      } else if (isDelta(scene.bsdfs, materialAt(scene, previous.id), previous.lobe)) {
        ray = scatterDelta<T>(scene, ray, camera, previous.id, previous.lobe, Side::kCamera);
      } else {
        const Vec3<T> direction = towardsNext(path, i - 1, camera.point.p);
        ray = scatterTowards<T>(scene, camera, previous.id, camera.point.shading.toLocal(direction),
                                Side::kCamera);
      }
    }
    const bool escapes = path.escaped && i == last;
    if (!escapes) {
      camera = stays ? PathVertex<T>(ray, [&] { return constant(traced.vertex.point); })
                     : arriveAt<T>(scene, ray, traced.id, &time);
    }
    if (stays && i <= reconnection + 2)
      logDensity = logDensity - log(escapes ? ray.vcm : camera.vcm);
  }
  if (technique.s >= 2) light = constant(path.light[at(technique.s) - 1].vertex);
  const int offset = technique.lightOffset();
  const T direct[2] = {T(u[offset]), T(u[offset + 1])};
  const T value =
      joinedLogTarget<T>(scene, path, ray, camera, light, direct, &time, aperture) + logDensity;

  result.dimension = 2;
  result.logTarget = value.v;
  for (int i = 0, k = 0; i < 2; ++i) {
    result.gradient[i] = value.gradient(i);
    for (int j = 0; j <= i; ++j, ++k) result.hessian[k] = value.hessian(i, j);
  }
}

}  // namespace h2mc
