// How two subpaths become a path: the techniques' last step, with their MIS weights. Visibility is
// the caller's.
#pragma once

#include <algorithm>

#include "render/path/subpath.h"

namespace h2mc {

// Which techniques the MIS weights reckon with.
enum class Techniques {
  kUnidirectional,  // s = 0 and 1: path tracing with next-event estimation
  kBidirectional,   // all with t >= 1, but for (s, t) = (1, 1)
};

// A technique's contribution: weight * value is what it adds to the film.
template <class T>
struct Contribution {
  Rgb<T> value;  // throughput of the whole path over its density
  T weight;      // MIS weight
  bool zero() const {
    return !(ad::value(value.x) > 0) && !(ad::value(value.y) > 0) && !(ad::value(value.z) > 0);
  }
  static Contribution none() { return {Rgb<T>(T(0)), T(0)}; }
};

// 1 / (1 + a^2 + b^2), a, b >= 0. Scaled by the largest of the three, so that neither the squares
// leave float's range nor the derivatives of the quotient, which has the square's cube in it.
template <class T>
T powerWeight(const T& a, const T& b) {
  using S = Scalar<T>;
  const S scale = S(1) / std::max({S(1), value(a), value(b)});
  const T x = a * scale, y = b * scale;
  return (scale * scale) / (x * x + y * y + scale * scale);
}

// s = 0: the camera subpath has arrived at the area light `light`, on its primitive `id`
// (which only matters if the light moves).
template <class T>
Contribution<T> hitAreaLight(const Scene& scene, const PathVertex<T>& vertex,
                             const Vec3<T>& direction, int light, int t, Techniques techniques,
                             PrimitiveId id = {}, const std::type_identity_t<T>* time = nullptr) {
  const auto& l = std::get<AreaLight>(scene.lights[static_cast<std::size_t>(light)]);
  const LightHit<T> hit =
      l.template hit<T>(scene.lightContext(), vertex.point, direction, id, time);
  Contribution<T> c{hit.radiance * vertex.throughput, T(1)};
  if (t == 2 || c.zero()) return c;
  const Scalar<T> pick = scene.lightPicker.probability(light);
  const bool both = techniques == Techniques::kBidirectional;
  c.weight = powerWeight(hit.directPdf * vertex.vcm * pick,
                         both ? hit.emissionPdf * vertex.vc * pick : T(0));
  return c;
}

// s = 0: the camera subpath has left the scene.
template <class T>
Contribution<T> hitEnvironment(const Scene& scene, const PathRay<T>& ray, int t,
                               Techniques techniques) {
  const int light = scene.environment;
  return std::visit(
      [&](const auto& l) -> Contribution<T> {
        if (!l.isEnvironment()) return Contribution<T>::none();
        const LightHit<T> hit =
            l.template hit<T>(scene.lightContext(), SurfacePoint<T>{}, ray.direction);
        Contribution<T> c{hit.radiance * ray.throughput, T(1)};
        if (t == 2 || c.zero()) return c;
        const Scalar<T> pick = scene.lightPicker.probability(light);
        const bool both = techniques == Techniques::kBidirectional;
        c.weight = powerWeight(hit.directPdf * ray.vcm * pick,
                               both ? hit.emissionPdf * ray.vc * pick : T(0));
        return c;
      },
      scene.lights[static_cast<std::size_t>(light)]);
}

// s = 1: next-event estimation from the camera subpath's last vertex. `direct` is left with the
// light's sample, for the shadow ray.
template <class T>
Contribution<T> connectToLight(const Scene& scene, const PathVertex<T>& vertex, PrimitiveId id,
                               int light, PrimitiveId primitive, const T& u0, const T& u1,
                               Techniques techniques, DirectLight<T>& direct,
                               const std::type_identity_t<T>* time = nullptr) {
  return std::visit(
      [&](const auto& l) -> Contribution<T> {
        direct =
            sampleDirectAt<T>(l, scene.lightContext(), primitive, vertex.point.p, u0, u1, time);
        if (!(value(direct.directPdf) > 0)) return Contribution<T>::none();
        const Vec3<T> wo = vertex.point.shading.toLocal(direct.direction);
        const BsdfValue<T> e =
            evaluateMaterial<T>(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi, wo);
        const Scalar<T> pick = scene.lightPicker.probability(light);
        const T inverse = T(1) / (direct.directPdf * pick);
        Contribution<T> c{vertex.throughput * direct.radiance * e.value * inverse, T(1)};
        if (c.zero()) return c;
        const T hitLight = l.isDelta() ? T(0) : e.pdf * inverse;
        T traced = T(0);
        if (techniques == Techniques::kBidirectional) {
          const T cosHere = abs(dot(vertex.point.ng, direct.direction));
          traced = direct.emissionPdf * cosHere / (direct.directPdf * direct.cosLight) *
                   rootOfSquares(vertex.vcm, vertex.vc * e.pdfReverse);
        }
        c.weight = powerWeight(hitLight, traced);
        return c;
      },
      scene.lights[static_cast<std::size_t>(light)]);
}

// s >= 2, t >= 2: an edge between the subpaths' last vertices.
template <class T>
Contribution<T> connectVertices(const Scene& scene, const PathVertex<T>& camera,
                                PrimitiveId cameraId, const PathVertex<T>& light,
                                PrimitiveId lightId) {
  const Vec3<T> edge = light.point.p - camera.point.p;
  const T inverse2 = T(1) / length2(edge);
  if (!(value(inverse2) < std::numeric_limits<Scalar<T>>::max())) return Contribution<T>::none();
  const Vec3<T> toLight = edge * sqrt(inverse2);
  const Vec3<T> wo = camera.point.shading.toLocal(toLight);
  const BsdfValue<T> ec =
      evaluateMaterial<T>(scene.bsdfs, materialAt(scene, cameraId), camera.point.uv, camera.wi, wo);
  if (!(value(ec.pdf) > 0)) return Contribution<T>::none();
  const Vec3<T> toCamera = light.point.shading.toLocal(-toLight);
  const BsdfValue<T> el = evaluateMaterial<T>(scene.bsdfs, materialAt(scene, lightId),
                                              light.point.uv, toCamera, light.wi);
  const T cosCamera = abs(dot(camera.point.ng, toLight));
  const T cosLight = abs(dot(light.point.ng, toLight));
  const T spread = cosLight * inverse2;
  Contribution<T> c{
      camera.throughput * ec.value * light.throughput * el.value * (spread / light.cosIn), T(1)};
  if (c.zero()) return c;
  const T fromCamera = ec.pdf * spread;
  const T fromLight = el.pdfReverse * cosCamera * inverse2;
  c.weight = powerWeight(fromCamera * rootOfSquares(light.vcm, light.vc * el.pdf),
                         fromLight * rootOfSquares(camera.vcm, camera.vc * ec.pdfReverse));
  return c;
}

// t = 1, s >= 2: the light subpath's last vertex is seen by the camera.
template <class T>
Contribution<T> connectToCamera(const Scene& scene, const PathVertex<T>& light, PrimitiveId id,
                                const std::type_identity_t<T>* time = nullptr) {
  return withCameraPose<T>(scene, time, [&](const auto& pose) {
    const Vec3<T> edge = light.point.p - pose.position;
    const T inverse2 = T(1) / length2(edge);
    const Vec3<T> fromCamera = edge * sqrt(inverse2);
    const T cosine = dot(pose.forward, fromCamera);
    if (!(value(cosine) > 0)) return Contribution<T>::none();
    const Vec3<T> wi = light.point.shading.toLocal(-fromCamera);
    const BsdfValue<T> e =
        evaluateMaterial<T>(scene.bsdfs, materialAt(scene, id), light.point.uv, wi, light.wi);
    const T cosHere = abs(dot(light.point.ng, fromCamera));
    const T cameraPdf = scene.camera.pdf(cosine) * cosHere * inverse2;  // per area
    Contribution<T> c{light.throughput * e.value * (cameraPdf / light.cosIn), T(1)};
    if (c.zero()) return c;
    c.weight = powerWeight(cameraPdf * rootOfSquares(light.vcm, light.vc * e.pdf), T(0));
    return c;
  });
}

}  // namespace h2mc
