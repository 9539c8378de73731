// SPDX-License-Identifier: MIT
#include "render/path/grow.h"

#include "render/bsdf/lobe_choice.h"
#include "render/core/index.h"

namespace h2mc {
namespace {

// Unit direction from x_i to where the path came from on this side's way.
Vec3f backwards(const FullPath& path, int i, Side side) {
  float distance;
  if (side == Side::kLight) return directionToLight(path, i, distance);
  return -directionToLight(path, i + 1, distance);
}

// Casts the ray; fills in the vertex.
bool find(const Scene& scene, const PathRay<float>& ray, bool fromCamera, float time,
          FullVertex& v) {
  v.id = nextPrimitive(scene, ray, fromCamera, time);
  v.delta = false;
  if (!v.id.valid()) return false;
  v.point = arriveAt<float>(scene, ray, v.id, &time).point;
  v.id = primitiveMet(scene, v.id);
  return true;
}

// The ray of the camera's side that may leave the scene as the path's last.
bool findOrEscape(const Scene& scene, const PathRay<float>& ray, FullPath& path, int next,
                  bool fromCamera) {
  if (next == 0) path.infinite = false;
  if (find(scene, ray, fromCamera, path.time, path.x[at(next)])) return true;
  if (next > 0 || !scene.hasEnvironment()) return false;
  path.infinite = true;
  path.escape = ray.direction;
  return true;
}

bool isRough(const Scene& scene, PrimitiveId id, float z, float threshold) {
  return widestLobe(scene.bsdfs, materialAt(scene, id), lobeSeenFrom(scene, id, LobeId{}, z)) >=
         threshold;
}

}  // namespace

bool Growth::leaveEye(float filmX, float filmY) {
  path.filmX = filmX;
  path.filmY = filmY;
  const PathRay<float> ray =
      startCamera<float>(scene, filmX, filmY, &path.time, path.aperture.data());
  return findOrEscape(scene, ray, path, path.edges - 1, true);
}

bool Growth::leave(int i, Side side, const Vec3f& direction) {
  PathRay<float> ray{};
  ray.origin = path.x[at(i)].point.p;
  ray.direction = direction;
  if (path.x[at(i)].id.valid()) ray.surface = path.x[at(i)].point.end();
  if (side == Side::kLight) return find(scene, ray, false, path.time, path.x[at(i) + 1]);
  return findOrEscape(scene, ray, path, i - 1, false);
}

bool Growth::arriveFromLight(const PathRay<float>& ray) {
  return find(scene, ray, false, path.time, path.x[1]);
}

bool Growth::scatter(int i, Side side, const ScatterSample& sample, Vec3f& direction) {
  FullVertex& v = path.x[at(i)];
  const Material& material = materialAt(scene, v.id);
  const SurfacePoint<float>& point = v.point;
  const Vec3f wi = point.shading.toLocal(backwards(path, i, side));
  v.lobe = chooseLobe(scene.bsdfs, material, point.uv, wi, sample.u.x, sample.u.y, sample.choice);
  v.delta = isDelta(scene.bsdfs, material, v.lobe);
  Vec3f wo;
  if (v.delta) {
    const DeltaSample<float> d = sampleDelta<float>(scene.bsdfs, material, point.uv, wi, v.lobe);
    if (dark(d.radiance)) return false;
    wo = d.wo;
    if (side == Side::kLight) v.lobe = lobeSeenFrom(scene, v.id, v.lobe, wo.z);
  } else {
    wo = sampleMaterial<float>(scene.bsdfs, material, point.uv, wi, v.lobe, sample.u.x, sample.u.y);
    if (!(evaluateMaterial<float>(scene.bsdfs, material, point.uv, wi, wo).pdf > 0)) return false;
  }
  direction = normalize(point.shading.toWorld(wo));
  return true;
}

bool scatterSample(const Scene& scene, const FullPath& path, int i, Side side, Random& random,
                   ScatterSample& sample) {
  const FullVertex& v = path.x[at(i)];
  const Frame<float>& frame = v.point.shading;
  const Vec3f wi = frame.toLocal(backwards(path, i, side));
  if (v.delta)
    return invertDelta(scene, v.id, v.point.uv, wi, lobeSeenFrom(scene, v.id, v.lobe, wi.z), random,
                       sample);
  const Vec3f wo =
      frame.toLocal(backwards(path, i, side == Side::kCamera ? Side::kLight : Side::kCamera));
  return invertScattering(scene, v.id, v.point.uv, wi, wo, random, sample);
}

bool joinable(const Scene& scene, const FullPath& path, int i, float threshold) {
  if (i == 0) return true;
  const FullVertex& v = path.x[at(i)];
  if (v.delta) return false;
  const float z = dot(v.point.shading.n, backwards(path, i, Side::kCamera));
  return isRough(scene, v.id, z, threshold);
}

bool joinable(const Scene& scene, const Path& path, int i, float threshold) {
  const auto [s, t] = path.technique;
  if (i == 0) return true;
  const int c = s + t - 1 - i;  // of the camera's vertices
  const bool ofCamera = i >= s;
  const TracedVertex& v = ofCamera ? path.camera[at(c)] : path.light[at(i)];
  const bool end = ofCamera ? c == t - 1 : i == s - 1;
  if (!end && isDelta(scene.bsdfs, materialAt(scene, v.id), v.lobe)) return false;
  if (ofCamera) return isRough(scene, v.id, v.vertex.wi.z, threshold);
  const SurfacePoint<float>& point = v.vertex.point;
  const auto onwards = [&, t = t]() -> Vec3f {
    if (!end) return path.light[at(i) + 1].vertex.point.p - point.p;
    if (t > 1) return path.camera[at(t) - 1].vertex.point.p - point.p;
    const CameraPose<float> pose = scene.camera.poseOf(path.sample.time, path.sample.aperture);
    return scene.camera.isParallel() ? -pose.forward : pose.position - point.p;
  };
  return isRough(scene, v.id, dot(point.shading.n, onwards()), threshold);
}

double nonDeltaProbability(const Scene& scene, const FullPath& path, int i) {
  const FullVertex& v = path.x[at(i)];
  const Vec3f wi = v.point.shading.toLocal(backwards(path, i, Side::kCamera));
  return 1 - double(deltaProbability(scene.bsdfs, materialAt(scene, v.id), v.point.uv, wi));
}

}  // namespace h2mc
