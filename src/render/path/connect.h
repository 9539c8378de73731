// SPDX-License-Identifier: MIT
// How two subpaths become a path: the techniques' last step, with their MIS weights. Visibility is
// the caller's.
#pragma once

#include <algorithm>

#include "render/core/index.h"
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

// What a technique's last step adds to what the subpaths bring along. With x = light.vcm * light's vcm
// and so on, the MIS weight is 1 / (1 + direct^2 + the other four's squares). Zeros are structural.
template <class T>
struct Link {
  struct Factors {
    T vcm, vc;  // of the subpath's own
  };
  Rgb<T> value;
  T direct;
  Factors camera, light;

  bool zero() const {
    return !(ad::value(value.x) > 0) && !(ad::value(value.y) > 0) && !(ad::value(value.z) > 0);
  }
  explicit Link(const Rgb<T>& v) : value(v), direct(0), camera{T(0), T(0)}, light{T(0), T(0)} {}
  static Link none() { return Link(Rgb<T>(T(0))); }
};

// 1 / (1 + sum of squares of `terms`, all >= 0). Scaled by the largest, so that neither the squares
// leave float's range nor the derivatives of the quotient, which has the square's cube in it.
template <class T>
T powerWeight(const T* terms, int count) {
  using S = Scalar<T>;
  S largest(1);
  for (int i = 0; i < count; ++i) largest = std::max(largest, value(terms[i]));
  const S scale = S(1) / largest;
  T sum(scale * scale);
  for (int i = 0; i < count; ++i) {
    const T x = terms[i] * scale;
    sum = sum + x * x;
  }
  return (scale * scale) / sum;
}

template <class T>
inline constexpr const PathVertex<T>* kNoEnd = nullptr;

// The link's contribution with the subpaths' throughputs and weights. `camera` and `light` have the
// members throughput, vcm and vc of PathVertex and PathRay; either may be null.
template <class T, class Camera, class Light>
Contribution<T> contributionOf(const Link<T>& link, const Camera* camera, const Light* light) {
  Contribution<T> c{link.value, T(1)};
  if (camera) c.value = c.value * camera->throughput;
  if (light) c.value = c.value * light->throughput;
  if (c.zero()) return c;
  T terms[5];
  int count = 0;
  const auto add = [&](const T& x) {
    if (value(x) > 0) terms[count++] = x;
  };
  add(link.direct);
  const auto addBoth = [&](const typename Link<T>::Factors& factors, const auto& end) {
    if (value(factors.vcm) > 0) add(factors.vcm * end.vcm);
    if (value(factors.vc) > 0) add(factors.vc * end.vc);
  };
  if (camera) addBoth(link.camera, *camera);
  if (light) addBoth(link.light, *light);
  if (count > 0) c.weight = powerWeight(terms, count);
  return c;
}

// Gives the link of a light that was hit the densities of the other techniques there.
template <class T>
void weighHit(const Scene& scene, const LightHit<T>& hit, int light, Techniques techniques,
              Link<T>& link) {
  link.camera.vcm = hit.directPdf * Scalar<T>(scene.directPicker.probability(light));
  if (techniques == Techniques::kBidirectional)
    link.camera.vc = hit.emissionPdf * Scalar<T>(scene.emissionPicker.probability(light));
}

// s = 0: the camera subpath has arrived, in world direction `direction`, at the area light `light`, on
// its primitive `id` (which only matters if the light moves).
template <class T>
Link<T> linkOfAreaLight(const Scene& scene, const SurfacePoint<T>& point, const Vec3<T>& direction,
                        int light, int t, Techniques techniques, PrimitiveId id = {},
                        const std::type_identity_t<T>* time = nullptr) {
  const auto& l = std::get<AreaLight>(scene.lights[at(light)]);
  const LightHit<T> hit = l.template hit<T>(scene.lightContext(), point, direction, id, time);
  Link<T> link(hit.radiance);
  if (t > 2 && !link.zero()) weighHit(scene, hit, light, techniques, link);
  return link;
}

// s = 0: the camera subpath has left the scene in world direction `direction`.
template <class T>
Link<T> linkOfEnvironment(const Scene& scene, const Vec3<T>& direction, int t,
                          Techniques techniques) {
  const int light = scene.environmentAt(Vec3f(value3(direction)));
  if (light < 0) return Link<T>::none();
  return std::visit(
      [&](const auto& l) -> Link<T> {
        if (!l.isEnvironment()) return Link<T>::none();
        const LightHit<T> hit =
            l.template hit<T>(scene.lightContext(), SurfacePoint<T>{}, direction);
        Link<T> link(hit.radiance);
        if (t > 2 && !link.zero()) weighHit(scene, hit, light, techniques, link);
        return link;
      },
      scene.lights[at(light)]);
}

// s = 1: next-event estimation from the camera subpath's last vertex. `direct` is left with the
// light's sample, for the shadow ray.
template <class T>
Link<T> linkToLight(const Scene& scene, const Arrival<T>& vertex, PrimitiveId id, int light,
                    PrimitiveId primitive, const T& u0, const T& u1, Techniques techniques,
                    DirectLight<T>& direct, const std::type_identity_t<T>* time = nullptr) {
  return std::visit(
      [&](const auto& l) -> Link<T> {
        direct =
            sampleDirectAt<T>(l, scene.lightContext(), primitive, vertex.point.p, u0, u1, time);
        Link<T> link = Link<T>::none();
        if (!(value(direct.directPdf) > 0)) return link;
        if (bendBlocks(vertex, direct.direction, Side::kCamera)) return link;
        const Vec3<T> wo = vertex.point.shading.toLocal(direct.direction);
        const BsdfValue<T> e =
            evaluateMaterial<T>(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi, wo);
        const Scalar<T> pick = scene.directPicker.probability(light);
        const T inverse = T(1) / (direct.directPdf * pick);
        link.value = direct.arriving * e.value * (Scalar<T>(1) / pick);
        if (link.zero()) return link;
        if (!l.isDelta()) link.direct = e.pdf * inverse;
        if (techniques == Techniques::kBidirectional) {
          const T cosHere = geometricCosine(vertex.point, wo, direct.direction);
          link.camera.vcm = direct.emissionPdf * (scene.emissionPicker.probability(light) / pick) *
                            cosHere / (direct.directPdf * direct.cosLight);
          link.camera.vc = link.camera.vcm * e.pdfReverse;
        }
        return link;
      },
      scene.lights[at(light)]);
}

// s >= 2, t >= 2: an edge between the subpaths' last vertices.
template <class T>
Link<T> linkOfVertices(const Scene& scene, const Arrival<T>& camera, PrimitiveId cameraId,
                       const Arrival<T>& light, PrimitiveId lightId) {
  Link<T> link = Link<T>::none();
  const Vec3<T> edge = light.point.p - camera.point.p;
  const T inverse2 = T(1) / length2(edge);
  if (!(value(inverse2) < std::numeric_limits<Scalar<T>>::max())) return link;
  const Vec3<T> toLight = edge * sqrt(inverse2);
  if (bendBlocks(camera, toLight, Side::kCamera) ||
      bendBlocks(light, Vec3<T>(-toLight), Side::kLight))
    return link;
  const Vec3<T> wo = camera.point.shading.toLocal(toLight);
  const BsdfValue<T> ec =
      evaluateMaterial<T>(scene.bsdfs, materialAt(scene, cameraId), camera.point.uv, camera.wi, wo);
  if (!(value(ec.pdf) > 0)) return link;
  const Vec3<T> toCamera = light.point.shading.toLocal(-toLight);
  const BsdfValue<T> el = evaluateMaterial<T>(scene.bsdfs, materialAt(scene, lightId),
                                              light.point.uv, toCamera, light.wi);
  const T cosCamera = geometricCosine(camera.point, wo, toLight);
  const T cosLight = geometricCosine(light.point, toCamera, toLight);
  const T spread = cosLight * inverse2;
  link.value = ec.value * el.value * (spread / light.cosIn);
  if (link.zero()) return link;
  link.light.vcm = ec.pdf * spread;
  link.light.vc = link.light.vcm * el.pdf;
  link.camera.vcm = el.pdfReverse * cosCamera * inverse2;
  link.camera.vc = link.camera.vcm * ec.pdfReverse;
  return link;
}

// t = 1, s >= 2: the light subpath's last vertex is seen by the camera.
template <class T>
Link<T> linkToCamera(const Scene& scene, const Arrival<T>& light, PrimitiveId id,
                     const std::type_identity_t<T>* time = nullptr,
                     const std::type_identity_t<T>* aperture = nullptr) {
  return withCameraPose<T>(scene, time, aperture, [&](const auto& pose) {
    Link<T> link = Link<T>::none();
    const bool parallel = scene.camera.isParallel();
    const Vec3<T> edge = light.point.p - pose.position;
    const T inverse2 = parallel ? T(1) : T(1) / length2(edge);
    const Vec3<T> fromCamera = parallel ? liftFrom<T>(pose.forward) : edge * sqrt(inverse2);
    const T cosine = parallel ? T(1) : dot(pose.forward, fromCamera);
    if (!(value(cosine) > 0)) return link;
    if (bendBlocks(light, Vec3<T>(-fromCamera), Side::kLight)) return link;
    const Vec3<T> wi = light.point.shading.toLocal(-fromCamera);
    const BsdfValue<T> e =
        evaluateMaterial<T>(scene.bsdfs, materialAt(scene, id), light.point.uv, wi, light.wi);
    const T cosHere = geometricCosine(light.point, wi, fromCamera);
    const T cameraPdf = scene.camera.pdf(cosine) * cosHere * inverse2;  // per area
    link.value = e.value * (cameraPdf / light.cosIn);
    if (link.zero()) return link;
    link.light.vcm = cameraPdf;
    link.light.vc = cameraPdf * e.pdf;
    return link;
  });
}

// The same with what the subpaths bring along.
template <class T>
Contribution<T> hitAreaLight(const Scene& scene, const PathVertex<T>& vertex,
                             const Vec3<T>& direction, int light, int t, Techniques techniques,
                             PrimitiveId id = {}, const std::type_identity_t<T>* time = nullptr) {
  return contributionOf<T>(
      linkOfAreaLight<T>(scene, vertex.point, direction, light, t, techniques, id, time), &vertex,
      kNoEnd<T>);
}
template <class T>
Contribution<T> hitEnvironment(const Scene& scene, const PathRay<T>& ray, int t,
                               Techniques techniques) {
  return contributionOf<T>(linkOfEnvironment<T>(scene, ray.direction, t, techniques), &ray,
                           kNoEnd<T>);
}
template <class T>
Contribution<T> connectToLight(const Scene& scene, const PathVertex<T>& vertex, PrimitiveId id,
                               int light, PrimitiveId primitive, const T& u0, const T& u1,
                               Techniques techniques, DirectLight<T>& direct,
                               const std::type_identity_t<T>* time = nullptr) {
  return contributionOf<T>(
      linkToLight<T>(scene, vertex, id, light, primitive, u0, u1, techniques, direct, time),
      &vertex, kNoEnd<T>);
}
template <class T>
Contribution<T> connectVertices(const Scene& scene, const PathVertex<T>& camera,
                                PrimitiveId cameraId, const PathVertex<T>& light,
                                PrimitiveId lightId) {
  return contributionOf<T>(linkOfVertices<T>(scene, camera, cameraId, light, lightId), &camera,
                           &light);
}
template <class T>
Contribution<T> connectToCamera(const Scene& scene, const PathVertex<T>& light, PrimitiveId id,
                                const std::type_identity_t<T>* time = nullptr,
                                const std::type_identity_t<T>* aperture = nullptr) {
  return contributionOf<T>(linkToCamera<T>(scene, light, id, time, aperture), kNoEnd<T>, &light);
}

}  // namespace h2mc
