// SPDX-License-Identifier: MIT
#include "render/path/full_path.h"

#include <limits>

#include "render/core/index.h"

namespace h2mc {
namespace {

bool flipsNormals(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return sphere->flipNormals;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) return cylinder->flipNormals;
  if (const auto* moving = std::get_if<MovingCylinder>(&shape.geometry))
    return moving->steps.front().flipNormals;
  return std::get<MovingSphere>(shape.geometry).steps.front().flipNormals;
}

// The triangle that samplePrimitive puts the point (u0, u1) on.
PrimitiveId hitAs(const Scene& scene, PrimitiveId sampled, float u0, float u1) {
  if (scene.shapes[sampled.shape].isParallelogram()) sampled.primitive = u0 >= u1 ? 0 : 1;
  return sampled;
}

void setVertex(const Scene& scene, const TracedVertex& traced, FullVertex& v) {
  v.point = traced.vertex.point;
  v.id = primitiveMet(scene, traced.id);
  v.delta = false;
}

// The end on the light of a technique with s >= 1, x_1 being known.
void setLightPoint(const Scene& scene, const Path& path, FullPath& full) {
  const float* u = path.sample.u.data() + path.technique.lightOffset();
  Vec3f direction(0);
  if (path.technique.s >= 2) {
    const PathVertex<float>& first = path.light[1].vertex;
    direction = first.point.shading.toWorld(first.wi);
  }
  setLightPoint(scene, full, path.lightPrimitive, u[0], u[1],
                path.technique.s >= 2 ? &direction : nullptr);
}

// The delta lobes of a subpath, whose vertices 1 .. scatterings it goes on from; index(i): where its
// vertex i is in the full path.
template <class Index>
void setLobes(const Scene& scene, const std::vector<TracedVertex>& subpath, int scatterings,
              Index&& index, FullPath& full) {
  for (int i = 1; i <= scatterings; ++i) {
    const TracedVertex& traced = subpath[at(i)];
    FullVertex& v = full.x[at(index(i))];
    v.delta = isDelta(scene.bsdfs, materialAt(scene, traced.id), traced.lobe);
    v.lobe = traced.lobe;
  }
}

}  // namespace

PrimitiveId primitiveMet(const Scene& scene, PrimitiveId hit) {
  if (scene.shapes[hit.shape].hasTwoRoots()) hit.primitive = 0;
  return hit;
}

void setLightPoint(const Scene& scene, FullPath& full, PrimitiveId primitive, float u0, float u1,
                   const Vec3f* direction) {
  FullVertex& end = full.x[0];
  end.id = {};
  end.delta = false;
  full.lightPrimitive = {};
  const Light& light = scene.lights[at(full.light)];
  full.infinite = std::visit([](const auto& l) { return l.isInfinite(); }, light);
  if (std::holds_alternative<AreaLight>(light)) {
    full.lightPrimitive = primitive;
    end.id = hitAs(scene, primitive, u0, u1);
    end.point = samplePrimitive<float>(scene.shapes, primitive, u0, u1, &full.time);
    return;
  }
  if (full.infinite && direction) {
    full.escape = *direction;
    return;
  }
  // Point lights do not care for the coordinates.
  const DirectLight<float> direct = std::visit(
      [&](const auto& l) {
        return sampleDirectAt<float>(l, scene.lightContext(), {}, full.x[1].point.p, u0, u1,
                                     &full.time);
      },
      light);
  full.escape = direct.direction;
  end.point.p = direct.position;
  end.point.ng = Vec3f(0);
}

bool setLightHit(const Scene& scene, FullPath& full) {
  const PrimitiveId hit = full.x[0].id;
  full.infinite = !hit.valid();
  full.lightPrimitive = {};
  full.light = hit.valid() ? scene.shapes[hit.shape].light : scene.environmentAt(full.escape);
  if (full.light < 0) return false;
  // What is sampled as a whole is called by its first primitive.
  if (hit.valid()) {
    full.lightPrimitive = hit;
    const Shape& shape = scene.shapes[hit.shape];
    if (shape.isParallelogram() || !shape.isMesh()) full.lightPrimitive.primitive = 0;
  }
  full.x[0].delta = false;
  return true;
}

LobeId lobeSeenFrom(const Scene& scene, PrimitiveId id, LobeId lobe, float wiZ) {
  const Material& material = detail::partOf(materialAt(scene, id), lobe);
  detail::seen(std::span(scene.bsdfs), material, wiZ, lobe.back);
  return lobe;
}

PrimitiveId primitiveSeen(const Scene& scene, const FullVertex& v, const Vec3f& direction) {
  PrimitiveId id = v.id;
  if (!id.valid() || !scene.shapes[id.shape].hasTwoRoots()) return id;
  const bool outwards = (dot(direction, v.point.ng) > 0) != flipsNormals(scene.shapes[id.shape]);
  id.primitive = outwards ? 1 : 0;
  return id;
}

Vec3f directionToLight(const FullPath& path, int i, float& distance) {
  if (i == 1 && path.infinite) {
    distance = std::numeric_limits<float>::infinity();
    return path.escape;
  }
  if (i == path.edges && path.parallel) {
    distance = std::numeric_limits<float>::infinity();
    return path.view;
  }
  const Vec3f edge = path.x[at(i) - 1].point.p - path.x[at(i)].point.p;
  distance = sqrt(length2(edge));
  return edge * (1 / distance);
}

bool toFull(const Scene& scene, const Path& path, FullPath& full) {
  if (!(path.target > 0)) return false;
  const auto [s, t] = path.technique;
  const int k = path.technique.length();
  full.edges = k;
  full.light = path.lightIndex;
  full.time = path.sample.time;
  full.aperture = path.sample.aperture;
  full.filmX = path.filmX;
  full.filmY = path.filmY;
  full.infinite = false;
  full.lightPrimitive = {};

  FullVertex& eye = full.x[at(k)];
  eye = FullVertex{};
  eye.point.p = scene.camera.poseOf(full.time, full.aperture).position;
  eye.point.ng = Vec3f(0);
  full.parallel = scene.camera.isParallel();
  full.view = scene.camera.forwardOf(full.time);
  const int cameraVertices = path.escaped ? t - 2 : t - 1;
  for (int i = 1; i <= cameraVertices; ++i) setVertex(scene, path.camera[at(i)], full.x[at(k - i)]);
  for (int i = 1; i < s; ++i) setVertex(scene, path.light[at(i)], full.x[at(i)]);
  if (s >= 1) {
    setLightPoint(scene, path, full);
  } else {
    if (path.escaped) {
      full.escape = path.lastRay.direction;
      full.x[0].id = {};
    }
    setLightHit(scene, full);
  }

  setLobes(
      scene, path.camera, t - 2, [&](int i) { return k - i; }, full);
  setLobes(
      scene, path.light, s - 2, [](int i) { return i; }, full);
  for (int i = 1; i <= s - 2; ++i) {
    FullVertex& v = full.x[at(i)];
    if (!v.delta) continue;
    const Vec3f toCamera = full.x[at(i) + 1].point.p - v.point.p;
    v.lobe = lobeSeenFrom(scene, v.id, v.lobe, dot(v.point.shading.n, toCamera));
  }
  return true;
}

}  // namespace h2mc
