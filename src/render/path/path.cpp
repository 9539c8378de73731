#include "render/path/path.h"

#include <chrono>
#include <cmath>

#include "render/geometry/ray_tracer.h"

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

bool dark(const Rgbf& c) { return !(c.x > 0) && !(c.y > 0) && !(c.z > 0); }

bool withinClip(const Camera& camera, float depth) {
  return depth >= camera.nearClip && depth <= camera.farClip;
}

void markScatterWraps(const Scene& scene, Path& path, const TracedVertex& vertex, int coordinate) {
  // A lobe's second coordinate is its azimuth; a delta lobe uses neither.
  const bool delta = isDelta(scene.bsdfs, materialAt(scene, vertex.id), vertex.lobe);
  path.wraps |= CoordinateMask(delta ? 3 : 2) << coordinate;
}

PathRay<float> scatter(const Scene& scene, Path& path, TracedVertex& v, int coordinate,
                       float choice, Side side) {
  const float u0 = path.sample.u[static_cast<std::size_t>(coordinate)];
  const float u1 = path.sample.u[static_cast<std::size_t>(coordinate) + 1];
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

}  // namespace

RaySeconds::RaySeconds(bool on) {
  if (on) raySeconds = &seconds_;
}
RaySeconds::~RaySeconds() { raySeconds = nullptr; }

PrimitiveId nextPrimitive(const Scene& scene, const PathRay<float>& ray, bool fromCamera) {
  float nearest = 0, farthest = RayTracer::kFar;
  if (fromCamera) {
    const float cosine = scene.camera.cosine(ray.direction);
    nearest = scene.camera.nearClip / cosine;
    farthest = scene.camera.farClip / cosine;
  }
  return timedQuery([&] {
    return scene.tracer->intersect(ray.origin, ray.originNormal, ray.direction, nearest, farthest);
  });
}

bool pointEscapes(const Scene& scene, const SurfacePoint<float>& point, const Vec3f& direction) {
  return timedQuery([&] { return scene.tracer->escapes(point.p, point.ng, direction); });
}

bool pointsVisible(const Scene& scene, const SurfacePoint<float>& a, const SurfacePoint<float>& b) {
  return timedQuery([&] { return scene.tracer->visible(a.p, a.ng, b.p, b.ng); });
}

bool lightVisible(const Scene& scene, const SurfacePoint<float>& point, int light,
                  const DirectLight<float>& direct) {
  const Light& l = scene.lights[static_cast<std::size_t>(light)];
  if (std::visit([](const auto& x) { return x.isInfinite(); }, l))
    return pointEscapes(scene, point, direct.direction);
  return timedQuery(
      [&] { return scene.tracer->visible(point.p, point.ng, direct.position, direct.normal); });
}

bool cameraVisible(const Scene& scene, const SurfacePoint<float>& point, float& filmX,
                   float& filmY) {
  const Vec3f fromCamera = point.p - scene.camera.position();
  return withinClip(scene.camera, dot(scene.camera.forward(), fromCamera)) &&
         scene.camera.project(fromCamera, filmX, filmY) && timedQuery([&] {
           return scene.tracer->visible(point.p, point.ng, scene.camera.position(), Vec3f(0));
         });
}

Step stepCamera(const Scene& scene, Path& path, int i) {
  const Technique& technique = path.technique;
  PathRay<float> ray;
  if (i == 1) {
    path.filmX = path.sample.u[0];
    path.filmY = path.sample.u[1];
    ray = startCamera<float>(scene, path.filmX, path.filmY);
  } else {
    ray = scatter(scene, path, path.camera[static_cast<std::size_t>(i) - 1],
                  technique.cameraCoordinate(i - 1),
                  path.sample.choice[static_cast<std::size_t>(technique.cameraChoice(i - 1))],
                  Side::kCamera);
    if (dark(ray.throughput)) return Step::kDead;
  }
  path.lastRay = ray;
  TracedVertex& v = path.camera[static_cast<std::size_t>(i)];
  v.id = nextPrimitive(scene, ray, i == 1);
  if (!v.id.valid()) return Step::kEscaped;
  v.vertex = arriveAt<float>(scene, ray, v.id);
  return Step::kArrived;
}

bool traceCamera(const Scene& scene, Path& path, int first) {
  const auto [s, t] = path.technique;
  path.escaped = false;
  for (int i = first; i < t; ++i) {
    const Step step = stepCamera(scene, path, i);
    if (step == Step::kArrived) continue;
    path.escaped = step == Step::kEscaped && s == 0 && i == t - 1 && scene.environment >= 0;
    return path.escaped;
  }
  return true;
}

bool pickLight(const Scene& scene, float choice, int& light, PrimitiveId& primitive) {
  const LightPicker::Choice pick = scene.lightPicker.choose(choice);
  if (pick.light < 0) return false;
  light = pick.light;
  primitive = std::visit(
      [&](const auto& l) { return l.choosePrimitive(scene.lightContext(), pick.remainder); },
      scene.lights[static_cast<std::size_t>(light)]);
  return true;
}

Step stepLight(const Scene& scene, Path& path, int i) {
  const Technique& technique = path.technique;
  PathRay<float> ray;
  if (i == 1) {
    const float* u = path.sample.u.data() + technique.lightOffset();
    ray = startLight<float>(scene, path.lightIndex, path.lightPrimitive, u[0], u[1], u[2], u[3]);
  } else {
    ray = scatter(
        scene, path, path.light[static_cast<std::size_t>(i) - 1], technique.lightCoordinate(i - 1),
        path.sample.choice[static_cast<std::size_t>(technique.lightChoice(i - 1))], Side::kLight);
  }
  if (dark(ray.throughput)) return Step::kDead;
  TracedVertex& v = path.light[static_cast<std::size_t>(i)];
  v.id = nextPrimitive(scene, ray, false);
  if (!v.id.valid()) return Step::kEscaped;
  v.vertex = arriveAt<float>(scene, ray, v.id);
  return Step::kArrived;
}

bool traceLight(const Scene& scene, Path& path) {
  const Technique& technique = path.technique;
  if (technique.s == 0) return true;
  if (!pickLight(scene, path.sample.choice[static_cast<std::size_t>(technique.lightPick())],
                 path.lightIndex, path.lightPrimitive))
    return false;
  const unsigned wraps = std::visit(
      [&](const auto& l) {
        return technique.s == 1 ? l.wrapsDirect(scene.lightContext())
                                : l.wrapsEmission(scene.lightContext());
      },
      scene.lights[static_cast<std::size_t>(path.lightIndex)]);
  path.wraps |= CoordinateMask(wraps) << technique.lightOffset();
  for (int i = 1; i < technique.s; ++i)
    if (stepLight(scene, path, i) != Step::kArrived) return false;
  return true;
}

Joined join(const Scene& scene, const Ends& ends) {
  const auto [s, t] = ends.technique;
  constexpr auto kBoth = Techniques::kBidirectional;
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
    finish(hitAreaLight<float>(scene, v, -v.point.shading.toWorld(v.wi), light, t, kBoth), joined);
    return joined;
  }
  if (s == 1) {
    DirectLight<float> direct;
    finish(connectToLight<float>(scene, ends.camera->vertex, ends.camera->id, ends.lightIndex,
                                 ends.lightPrimitive, ends.u0, ends.u1, kBoth, direct),
           joined);
    if (dark(joined.contribution)) return joined;
    visible = lightVisible(scene, ends.camera->vertex.point, ends.lightIndex, direct);
  } else if (t == 1) {
    finish(connectToCamera<float>(scene, ends.light->vertex, ends.light->id), joined);
    if (dark(joined.contribution)) return joined;
    visible = cameraVisible(scene, ends.light->vertex.point, joined.filmX, joined.filmY);
  } else {
    const TracedVertex &camera = *ends.camera, &light = *ends.light;
    finish(connectVertices<float>(scene, camera.vertex, camera.id, light.vertex, light.id), joined);
    if (dark(joined.contribution)) return joined;
    visible = pointsVisible(scene, camera.vertex.point, light.vertex.point);
  }
  if (!visible) joined.contribution = Rgbf(0);
  return joined;
}

bool joinSubpaths(const Scene& scene, Path& path) {
  const auto [s, t] = path.technique;
  const float* u = path.sample.u.data() + path.technique.lightOffset();
  const TracedVertex* camera = &path.camera[static_cast<std::size_t>(t) - 1];
  const TracedVertex* light = s >= 2 ? &path.light[static_cast<std::size_t>(s) - 1] : nullptr;
  const bool direct = s == 1;
  const Joined joined =
      join(scene, {path.technique, path.escaped ? nullptr : camera, light, &path.lastRay,
                   path.lightIndex, path.lightPrimitive, direct ? u[0] : 0, direct ? u[1] : 0});
  if (s == 0)
    path.lightIndex = path.escaped ? scene.environment : scene.shapes[camera->id.shape].light;
  if (t == 1) {
    path.filmX = joined.filmX;
    path.filmY = joined.filmY;
  }
  path.finite = joined.finite;
  path.contribution = joined.contribution;
  path.target = luminance(joined.contribution);
  return path.target > 0;
}

bool tracePath(const Scene& scene, Path& path) {
  path.contribution = Rgbf(0);
  path.target = 0;
  path.finite = true;
  path.wraps = 0;
  return traceCamera(scene, path) && traceLight(scene, path) && joinSubpaths(scene, path);
}

}  // namespace h2mc
