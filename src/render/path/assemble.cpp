// SPDX-License-Identifier: MIT
#include "render/path/assemble.h"

#include "render/core/index.h"
#include "render/core/unit_interval.h"
#include "render/path/path_steps.h"
#include "render/path/reconnect.h"

namespace h2mc {
namespace {

// How far a vertex may end up from where it was wanted, in lengths of the edge that leads there.
constexpr float kMiss = 1e-3f;
// Draws of a coordinate in an interval that may have few floats.
constexpr int kTries = 8;

class Assembly {
 public:
  Assembly(const Scene& scene, const FullPath& full, Random& random, Path& path)
      : scene_(scene), full_(full), random_(random), path_(path) {}

  bool camera();
  bool light();

 private:
  // Where vertex i of a side's subpath is in the full path.
  int index(Side side, int i) const { return side == Side::kCamera ? full_.edges - i : i; }
  // The primitive of the full path's vertex that a ray from `origin` finds; none where it escapes.
  PrimitiveId seen(int vertex, const Vec3f& origin) const {
    if (vertex == 0 && full_.infinite) return {};
    const FullVertex& v = full_.x[at(vertex)];
    return primitiveSeen(scene_, v, v.point.p - origin);
  }
  // Whether the subpath's vertex i, met from `origin`, is where it should be.
  bool arrived(Side side, int i, const Vec3f& origin) const {
    const Vec3f& p = (side == Side::kCamera ? path_.camera : path_.light)[at(i)].vertex.point.p;
    const Vec3f& wanted = full_.x[at(index(side, i))].point.p;
    return distance2(p, wanted) <= kMiss * kMiss * distance2(wanted, origin);
  }
  // The ray that starts a subpath arrives at its first vertex.
  bool arriveFirst(Side side, const PathRay<float>& ray);
  // Scatterings 1 .. count of a subpath.
  bool scatter(Side side, int count);
  // The coordinate that chooses light and primitive. invert(light, choice) turns a remainder into the
  // coordinate that chooses the primitive.
  template <class Invert>
  bool pick(const LightPicker& picker, Invert&& invert);
  bool direct();    // s = 1
  bool emission();  // s >= 2
  Vec2f unused() {
    const float a = random_.uniform();
    return {a, random_.uniform()};
  }
  void setCoordinates(int k, const Vec2f& u) {
    path_.sample.u[at(k)] = u.x;
    path_.sample.u[at(k) + 1] = u.y;
  }

  const Scene& scene_;
  const FullPath& full_;
  Random& random_;
  Path& path_;
};

bool Assembly::arriveFirst(Side side, const PathRay<float>& ray) {
  if (dark(ray.throughput)) return false;
  const FullVertex& wanted = full_.x[at(index(side, 1))];
  TracedVertex& v = (side == Side::kCamera ? path_.camera : path_.light)[1];
  v.id = primitiveSeen(scene_, wanted, ray.direction);
  v.vertex = arriveAt<float>(scene_, ray, v.id, &path_.sample.time);
  return arrived(side, 1, ray.origin);
}

bool Assembly::scatter(Side side, int count) {
  std::vector<TracedVertex>& vertices = side == Side::kCamera ? path_.camera : path_.light;
  const Technique& technique = path_.technique;
  for (int i = 1; i <= count; ++i) {
    const TracedVertex& v = vertices[at(i)];
    const Vec3f here = v.vertex.point.p;
    const int next = index(side, i + 1);
    const FullVertex& wanted = full_.x[at(index(side, i))];
    if (wanted.delta) {
      const LobeId lobe = lobeSeenFrom(scene_, v.id, wanted.lobe, v.vertex.wi.z);
      if (!aimDelta(scene_, path_, side, i, lobe, random_)) return false;
    } else {
      const Vec3f direction = next == 0 && full_.infinite
                                  ? full_.escape
                                  : Vec3f(normalize(full_.x[at(next)].point.p - here));
      if (!aim(scene_, path_, side, i, direction, random_)) return false;
    }
    markScatterWraps(
        scene_, path_, v,
        side == Side::kCamera ? technique.cameraCoordinate(i) : technique.lightCoordinate(i));
    if (!follow(scene_, path_, side, i, seen(next, here))) return false;
    if (path_.escaped ? distance2(path_.lastRay.direction, full_.escape) > kMiss * kMiss
                      : !arrived(side, i + 1, here))
      return false;
  }
  return true;
}

bool Assembly::camera() {
  const auto [s, t] = path_.technique;
  if (t == 1) return true;
  const CameraPose<float> pose = scene_.camera.poseOf(full_.time, full_.aperture);
  const bool escapes = s == 0 && full_.infinite;
  const bool straight = escapes && t == 2;
  const Vec3f direction =
      straight ? full_.escape : full_.x[at(full_.edges) - 1].point.p - pose.position;
  float* u = path_.sample.u.data();
  if (straight && full_.parallel) {
    u[0] = full_.filmX;
    u[1] = full_.filmY;
  } else if (!scene_.camera.project(pose, direction, u[0], u[1])) {
    return false;
  }
  path_.filmX = u[0];
  path_.filmY = u[1];
  path_.lastRay =
      startCamera<float>(scene_, u[0], u[1], &path_.sample.time, path_.sample.aperture.data());
  if (straight) {
    path_.escaped = true;
    return true;
  }
  return arriveFirst(Side::kCamera, path_.lastRay) && scatter(Side::kCamera, t - 2);
}

template <class Invert>
bool Assembly::pick(const LightPicker& picker, Invert&& invert) {
  const Light& light = scene_.lights[at(full_.light)];
  float& coordinate = path_.sample.choice[at(path_.technique.lightPick())];
  for (int i = 0; i < kTries; ++i) {
    const float remainder = random_.uniform();
    float choice = remainder;
    if (!std::visit([&](const auto& l) { return invert(l, choice); }, light)) return false;
    if (!std::holds_alternative<AreaLight>(light))
      choice = remainder;  // there is nothing to choose
    coordinate = picker.invert(full_.light, choice);
    int picked;
    PrimitiveId primitive;
    if (coordinate >= 0 && pickLight(scene_, picker, coordinate, picked, primitive) &&
        picked == full_.light && primitive == full_.lightPrimitive)
      return true;
  }
  return false;
}

bool Assembly::direct() {
  const Vec3f& reference = path_.camera[at(path_.technique.t) - 1].vertex.point.p;
  const Vec3f edge = full_.x[0].point.p - reference;
  const float distance = full_.infinite ? 0 : sqrt(length2(edge));
  const Vec3f direction = full_.infinite ? full_.escape : edge * (1 / distance);
  const LightContext context = scene_.lightContext();
  Vec2f u;
  const bool found = pick(scene_.directPicker, [&](const auto& l, float& choice) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, AreaLight>)
      return l.invertDirect(context, full_.lightPrimitive, reference, direction, distance, u,
                            choice, &full_.time);
    else
      return l.invertDirect(context, {}, reference, direction, distance, u, choice);
  });
  if (!found) return false;
  const Light& light = scene_.lights[at(full_.light)];
  if (std::visit([](const auto& l) { return l.isDelta(); }, light)) u = unused();
  setCoordinates(path_.technique.lightOffset(), u);
  return true;
}

bool Assembly::emission() {
  const LightContext context = scene_.lightContext();
  const Vec3f& first = full_.x[1].point.p;
  const Vec3f& origin = full_.infinite ? first : full_.x[0].point.p;
  const Vec3f direction = full_.infinite ? -full_.escape : normalize(Vec3f(first - origin));
  Vec2f u, v;
  const bool found = pick(scene_.emissionPicker, [&](const auto& l, float& choice) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, AreaLight>)
      return l.invertEmission(context, full_.lightPrimitive, origin, direction, u, v, choice,
                              &full_.time);
    else
      return l.invertEmission(context, {}, origin, direction, u, v, choice);
  });
  if (!found) return false;
  const Light& light = scene_.lights[at(full_.light)];
  if (std::visit([](const auto& l) { return l.isDelta(); }, light))
    (full_.infinite ? v : u) = unused();
  if (isBeam(light)) v = unused();
  const int offset = path_.technique.lightOffset();
  setCoordinates(offset, u);
  setCoordinates(offset + 2, v);
  return arriveFirst(Side::kLight, startLight<float>(scene_, full_.light, full_.lightPrimitive, u.x,
                                                     u.y, v.x, v.y, &path_.sample.time));
}

bool Assembly::light() {
  const int s = path_.technique.s;
  if (s == 0) return true;
  if (!(s == 1 ? direct() : emission())) return false;
  markLightWraps(scene_, path_);
  return scatter(Side::kLight, s - 2);
}

}  // namespace

bool edgeVisible(const Scene& scene, const FullPath& full, int i) {
  const SurfacePoint<float>& from = full.x[at(i)].point;
  const bool escapes = i == 1 && full.infinite;
  if (i == full.edges) {
    float filmX, filmY;
    if (!escapes)
      return cameraVisible(scene, full.x[at(i) - 1].point, full.time, full.aperture, filmX, filmY);
    PathRay<float> ray{};
    if (full.parallel) {
      ray = startCamera<float>(scene, full.filmX, full.filmY, &full.time);
    } else {
      if (!scene.camera.project(scene.camera.poseOf(full.time, full.aperture), full.escape, filmX,
                                filmY))
        return false;
      ray.origin = from.p;
      ray.direction = full.escape;
    }
    return !nextPrimitive(scene, ray, true, full.time).valid();
  }
  if (escapes) return pointEscapes(scene, from, full.escape, full.time);
  return pointsVisible(scene, from, full.x[at(i) - 1].point, full.time);
}

bool assemble(const Scene& scene, const FullPath& full, Technique technique, EdgeMask cast,
              Random& random, Path& path) {
  const auto [s, t] = technique;
  const int k = full.edges;
  const auto joinable = [&](int i) { return !full.x[at(i)].delta; };
  if (technique == Technique{1, 1} || (s >= 1 && !(joinable(s) && joinable(s - 1)))) return false;
  const Light& light = scene.lights[at(full.light)];
  if (s == 0 && std::visit([](const auto& l) { return l.isDelta(); }, light)) return false;
  path.technique = technique;
  path.sample.time = full.time;
  path.sample.aperture = full.aperture;
  path.wraps = 0;
  path.escaped = false;
  path.lightIndex = full.light;
  path.lightPrimitive = full.lightPrimitive;
  Assembly assembly(scene, full, random, path);
  if (!assembly.camera() || !assembly.light() || !joinVisible(scene, path)) return false;
  for (int i = 1; i <= k; ++i)
    if ((cast & edgeBit(i)) && !edgeVisible(scene, full, i)) return false;
  return path.lightIndex == full.light;
}

}  // namespace h2mc
