// SPDX-License-Identifier: MIT
#include "render/path/path.h"

#include <chrono>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/geometry/ray_offset.h"
#include "render/geometry/ray_tracer.h"
#include "render/path/path_steps.h"

namespace h2mc {
namespace {

// Where this thread's ray seconds go; null for the many mutations that are not timed.
thread_local double* raySeconds = nullptr;

template <class Query>
auto timedQuery(Query&& query) {
  if (!raySeconds) [[likely]]
    return query();
  const auto start = std::chrono::steady_clock::now();
  const auto result = query();
  *raySeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

bool withinClip(const Camera& camera, float depth) {
  return depth >= camera.nearClip && depth <= camera.farClip;
}

// Where the ray from the camera to `p` starts: nearClip / cosine along it, as in nextPrimitive. What lies
// before it hides nothing.
Vec3f onNearPlane(const Camera& camera, const CameraPose<float>& pose, const Vec3f& p) {
  const Vec3f fromCamera = p - pose.position;
  if (camera.isParallel())
    return p + pose.forward * (camera.nearClip - dot(pose.forward, fromCamera));
  return pose.position + fromCamera * (camera.nearClip / dot(pose.forward, fromCamera));
}

PathRay<float> scatter(const Scene& scene, Path& path, TracedVertex& v, int coordinate,
                       float choice, Side side) {
  const float u0 = path.sample.u[at(coordinate)];
  const float u1 = path.sample.u[at(coordinate) + 1];
  v.lobe = chooseLobe(scene.bsdfs, materialAt(scene, v.id), v.vertex.point.uv, v.vertex.wi, u0, u1,
                      choice);
  markScatterWraps(scene, path, v, coordinate);
  return scatterFrom<float>(scene, v.vertex, v.id, v.lobe, u0, u1, side);
}

// MIS-weighted value; flags what is not finite.
void finish(const Contribution<float>& c, Joined& joined) {
  const Rgbf value = c.value * c.weight;
  const float sum = value.x + value.y + value.z;
  joined.finite = sum >= 0 && sum <= std::numeric_limits<float>::max();
  joined.contribution = joined.finite ? value : Rgbf(0);
}

bool cameraSees(const Scene& scene, const CameraPose<float>& pose, const SurfacePoint<float>& point,
                float& filmX, float& filmY) {
  const Vec3f fromCamera = point.p - pose.position;
  return withinClip(scene.camera, dot(pose.forward, fromCamera)) &&
         scene.camera.project(pose, fromCamera, filmX, filmY);
}

// The first primitive along a ray that starts at a point light, met by a ray from there: `found`, unless the light lies
// in its plane as far as rounding can tell. RayTracer::visible() says that it does not light that surface; half of its
// light would be a spot there that no other technique finds.
PrimitiveId beyondPlanes(const Scene& scene, const PathRay<float>& ray, float time,
                         PrimitiveId found) {
  RayEnd from{ray.origin};
  constexpr int kMostPlanes = 3;  // of a corner
  for (int i = 0; found.valid() && i < kMostPlanes; ++i) {
    const RayEnd met =
        intersectPrimitive(scene.shapes, found, ray.origin, ray.direction, &time).end();
    if (!RayOffset::inPlane(met, ray.origin)) break;
    from.normal += dot(met.normal, ray.direction) < 0 ? -met.normal : met.normal;
    from.shape = met.shape;
    found = scene.tracer->intersect(from, ray.direction, 0, RayTracer::kFar, time);
  }
  return found;
}

}  // namespace

void markScatterWraps(const Scene& scene, Path& path, const TracedVertex& vertex, int coordinate) {
  // A lobe's second coordinate is its azimuth; a delta lobe uses neither.
  const bool delta = isDelta(scene.bsdfs, materialAt(scene, vertex.id), vertex.lobe);
  path.wraps |= CoordinateMask(delta ? 3 : 2) << coordinate;
}

void markLightWraps(const Scene& scene, Path& path) {
  const Technique& technique = path.technique;
  const unsigned wraps = std::visit(
      [&](const auto& l) {
        return technique.s == 1 ? l.wrapsDirect(scene.lightContext())
                                : l.wrapsEmission(scene.lightContext());
      },
      scene.lights[at(path.lightIndex)]);
  path.wraps |= CoordinateMask(wraps) << technique.lightOffset();
}

RaySeconds::RaySeconds(bool on) {
  if (on) raySeconds = &seconds_;
}
RaySeconds::~RaySeconds() { raySeconds = nullptr; }

PrimitiveId nextPrimitive(const Scene& scene, const PathRay<float>& ray, bool fromCamera,
                          float time) {
  float nearest = 0, farthest = RayTracer::kFar;
  if (fromCamera) {
    const float cosine = dot(scene.camera.forwardOf(time), ray.direction);
    nearest = scene.camera.nearClip / cosine;
    farthest = scene.camera.farClip / cosine;
  }
  return timedQuery([&] {
    const bool open = ray.surface.shape == ~0u;
    const PrimitiveId found = scene.tracer->intersect(open ? RayEnd{ray.origin} : ray.surface,
                                                      ray.direction, nearest, farthest, time);
    if (!open || fromCamera || ray.fromInfinity) [[likely]]
      return found;
    return beyondPlanes(scene, ray, time, found);
  });
}

bool pointEscapes(const Scene& scene, const SurfacePoint<float>& point, const Vec3f& direction,
                  float time) {
  return timedQuery([&] { return scene.tracer->escapes(point.end(), direction, time); });
}

bool pointsVisible(const Scene& scene, const SurfacePoint<float>& a, const SurfacePoint<float>& b,
                   float time) {
  return timedQuery([&] { return scene.tracer->visible(a.end(), b.end(), time); });
}

bool lightVisible(const Scene& scene, const SurfacePoint<float>& point, int light,
                  const DirectLight<float>& direct, float time) {
  const Light& l = scene.lights[at(light)];
  if (std::visit([](const auto& x) { return x.isInfinite(); }, l))
    return pointEscapes(scene, point, direct.direction, time);
  RayEnd end{direct.position, direct.normal};
  if (const auto* area = std::get_if<AreaLight>(&l))
    end.shape = static_cast<std::uint32_t>(area->shape);
  return timedQuery([&] { return scene.tracer->visible(point.end(), end, time); });
}

bool cameraVisible(const Scene& scene, const SurfacePoint<float>& point, float time,
                   const std::array<float, 2>& aperture, float& filmX, float& filmY) {
  const CameraPose<float> pose = scene.camera.poseOf(time, aperture);
  return cameraSees(scene, pose, point, filmX, filmY) && timedQuery([&] {
           return scene.tracer->visible(point.end(), {onNearPlane(scene.camera, pose, point.p)},
                                        time);
         });
}

bool touchesMotion(const Scene& scene, const Path& path) {
  if (!scene.moving) return false;
  if (scene.camera.moves()) return true;
  const auto moves = [&](const TracedVertex& v) { return scene.shapes[v.id.shape].moves(); };
  const auto [s, t] = path.technique;
  const int cameraEnd = path.escaped ? t - 1 : t;
  for (int i = 1; i < cameraEnd; ++i)
    if (moves(path.camera[at(i)])) return true;
  for (int i = 1; i < s; ++i)
    if (moves(path.light[at(i)])) return true;
  // Lights that are no shape stand still.
  return s >= 1 && path.lightPrimitive.valid() && scene.shapes[path.lightPrimitive.shape].moves();
}

Step stepCamera(const Scene& scene, Path& path, int i) {
  const Technique& technique = path.technique;
  PathRay<float> ray;
  if (i == 1) {
    path.filmX = path.sample.u[0];
    path.filmY = path.sample.u[1];
    ray = startCamera<float>(scene, path.filmX, path.filmY, &path.sample.time,
                             path.sample.aperture.data());
  } else {
    ray = scatter(scene, path, path.camera[at(i) - 1], technique.cameraCoordinate(i - 1),
                  path.sample.choice[at(technique.cameraChoice(i - 1))], Side::kCamera);
    if (dark(ray.throughput)) return Step::kDead;
  }
  path.lastRay = ray;
  TracedVertex& v = path.camera[at(i)];
  v.id = nextPrimitive(scene, ray, i == 1, path.sample.time);
  if (!v.id.valid()) return Step::kEscaped;
  v.vertex = arriveAt<float>(scene, ray, v.id, &path.sample.time);
  return Step::kArrived;
}

bool traceCamera(const Scene& scene, Path& path, int first) {
  const auto [s, t] = path.technique;
  path.escaped = false;
  for (int i = first; i < t; ++i) {
    const Step step = stepCamera(scene, path, i);
    if (step == Step::kArrived) continue;
    path.escaped = step == Step::kEscaped && s == 0 && i == t - 1 && scene.hasEnvironment();
    return path.escaped;
  }
  return true;
}

PrimitiveId pickPrimitive(const Scene& scene, int light, float choice) {
  return std::visit([&](const auto& l) { return l.choosePrimitive(scene.lightContext(), choice); },
                    scene.lights[at(light)]);
}

bool pickLight(const Scene& scene, const LightPicker& picker, float choice, int& light,
               PrimitiveId& primitive) {
  const LightPicker::Choice pick = picker.choose(choice);
  if (pick.light < 0) return false;
  light = pick.light;
  primitive = pickPrimitive(scene, light, pick.remainder);
  return true;
}

Step stepLight(const Scene& scene, Path& path, int i) {
  const Technique& technique = path.technique;
  PathRay<float> ray;
  if (i == 1) {
    const float* u = path.sample.u.data() + technique.lightOffset();
    ray = startLight<float>(scene, path.lightIndex, path.lightPrimitive, u[0], u[1], u[2], u[3],
                            &path.sample.time);
  } else {
    ray = scatter(scene, path, path.light[at(i) - 1], technique.lightCoordinate(i - 1),
                  path.sample.choice[at(technique.lightChoice(i - 1))], Side::kLight);
  }
  if (dark(ray.throughput)) return Step::kDead;
  TracedVertex& v = path.light[at(i)];
  v.id = nextPrimitive(scene, ray, false, path.sample.time);
  if (!v.id.valid()) return Step::kEscaped;
  v.vertex = arriveAt<float>(scene, ray, v.id, &path.sample.time);
  return Step::kArrived;
}

bool traceLight(const Scene& scene, Path& path) {
  const Technique& technique = path.technique;
  if (technique.s == 0) return true;
  const LightPicker& picker = technique.s == 1 ? scene.directPicker : scene.emissionPicker;
  if (!pickLight(scene, picker, path.sample.choice[at(technique.lightPick())], path.lightIndex,
                 path.lightPrimitive))
    return false;
  markLightWraps(scene, path);
  for (int i = 1; i < technique.s; ++i)
    if (stepLight(scene, path, i) != Step::kArrived) return false;
  return true;
}

namespace {

// As join() says; `cast`: whether with a shadow ray.
Joined joinEnds(const Scene& scene, const Ends& ends, bool cast) {
  const auto [s, t] = ends.technique;
  constexpr auto kBoth = Techniques::kBidirectional;
  const float time = ends.sample->time;
  Joined joined;
  bool visible = true;
  if (s == 0) {
    if (!ends.camera) {
      finish(hitEnvironment<float>(scene, *ends.ray, t, kBoth), joined);
      return joined;
    }
    const int light = scene.shapes[ends.camera->id.shape].light;
    if (light < 0) return joined;
    const PathVertex<float>& v = ends.camera->vertex;
    finish(hitAreaLight<float>(scene, v, -v.point.shading.toWorld(v.wi), light, t, kBoth,
                               ends.camera->id, &time),
           joined);
    return joined;
  }
  if (s == 1) {
    DirectLight<float> direct;
    finish(connectToLight<float>(scene, ends.camera->vertex, ends.camera->id, ends.lightIndex,
                                 ends.lightPrimitive, ends.u0, ends.u1, kBoth, direct, &time),
           joined);
    if (dark(joined.contribution)) return joined;
    visible =
        !cast || lightVisible(scene, ends.camera->vertex.point, ends.lightIndex, direct, time);
  } else if (t == 1) {
    const std::array<float, 2>& aperture = ends.sample->aperture;
    finish(
        connectToCamera<float>(scene, ends.light->vertex, ends.light->id, &time, aperture.data()),
        joined);
    if (dark(joined.contribution)) return joined;
    const SurfacePoint<float>& point = ends.light->vertex.point;
    visible = cast ? cameraVisible(scene, point, time, aperture, joined.filmX, joined.filmY)
                   : cameraSees(scene, scene.camera.poseOf(time, aperture), point, joined.filmX,
                                joined.filmY);
  } else {
    const TracedVertex &camera = *ends.camera, &light = *ends.light;
    finish(connectVertices<float>(scene, camera.vertex, camera.id, light.vertex, light.id), joined);
    if (dark(joined.contribution)) return joined;
    visible = !cast || pointsVisible(scene, camera.vertex.point, light.vertex.point, time);
  }
  if (!visible) joined.contribution = Rgbf(0);
  return joined;
}

bool joinPath(const Scene& scene, Path& path, bool cast) {
  const auto [s, t] = path.technique;
  const float* u = path.sample.u.data() + path.technique.lightOffset();
  const TracedVertex* camera = &path.camera[at(t) - 1];
  const TracedVertex* light = s >= 2 ? &path.light[at(s) - 1] : nullptr;
  const bool direct = s == 1;
  const Joined joined = joinEnds(
      scene,
      {path.technique, path.escaped ? nullptr : camera, light, &path.lastRay, path.lightIndex,
       path.lightPrimitive, direct ? u[0] : 0, direct ? u[1] : 0, &path.sample},
      cast);
  if (s == 0)
    path.lightIndex = path.escaped ? scene.environmentAt(path.lastRay.direction)
                                   : scene.shapes[camera->id.shape].light;
  if (t == 1) {
    path.filmX = joined.filmX;
    path.filmY = joined.filmY;
  }
  path.finite = joined.finite;
  path.contribution = joined.contribution;
  path.target = luminance(joined.contribution);
  path.moving = touchesMotion(scene, path);
  path.aperture = scene.camera.hasAperture();
  return path.target > 0;
}

}  // namespace

Joined join(const Scene& scene, const Ends& ends) { return joinEnds(scene, ends, true); }
bool joinSubpaths(const Scene& scene, Path& path) { return joinPath(scene, path, true); }
bool joinVisible(const Scene& scene, Path& path) { return joinPath(scene, path, false); }

void Path::archive(Archive& archive) {
  const std::size_t sizes[] = {camera.size(), light.size()};
  archive(technique, sample, camera, light, lightIndex, lightPrimitive, escaped, lastRay, wraps,
          moving, aperture, filmX, filmY, contribution, target, finite);
  if (camera.size() != sizes[0] || light.size() != sizes[1])
    throw ArchiveError("it has paths of another length");
}

bool tracePath(const Scene& scene, Path& path) {
  path.contribution = Rgbf(0);
  path.target = 0;
  path.finite = true;
  path.wraps = 0;
  return traceCamera(scene, path) && traceLight(scene, path) && joinSubpaths(scene, path);
}

}  // namespace h2mc
