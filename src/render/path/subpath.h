// SPDX-License-Identifier: MIT
// The local functions of which every path is made, over any scalar type: leave the camera or a
// light, arrive at a surface, scatter. With T = float they trace; with a derivative type they give
// the derivatives of what was traced, on the frozen topology.
//
// `time` is the moment of the shutter's opening, in [0, 1]. It may be null where nothing that the path
// touches moves: nothing then depends on it, and no derivative is wasted on it. `aperture` are the two
// coordinates of a point of the camera's lens; null where it has none.
//
// MIS weights follow the recursive form of Georgiev 2012 ("Implementing Vertex Connection and
// Merging", eqs. 31-40) for the power heuristic with exponent 2. Where the report squares every
// density, `vcm` and `vc` here are the square roots of its sums: their range stays that of the
// densities themselves, so that float neither overflows nor loses small terms.
#pragma once

#include <algorithm>
#include <type_traits>

#include "render/bsdf/material.h"
#include "render/core/index.h"
#include "render/geometry/surface.h"
#include "render/path/frame_map.h"
#include "render/scene/scene.h"

namespace h2mc {

// Which end of the path a subpath starts from.
enum class Side { kCamera, kLight };

// On its way from one vertex to the next.
template <class T>
struct PathRay {
  Vec3<T> origin;
  Vec3<T> direction;  // unit
  Rgb<T> throughput;  // of the subpath, divided by the densities that made it
  T vcm, vc;          // root of d_VCM, d_VC
  // The surface that it leaves or has gone straight on through, from where on rays are cast: kept for floats alone.
  // Of no shape: it starts at its origin, in the open.
  RayEnd surface;
  bool fromInfinity =
      false;  // left an infinite light or a parallel camera: its distance is no density's business
};

// |cos| with the geometric normal of a direction: `local` in the shading frame, `world` in the world.
template <class T>
T geometricCosine(const SurfacePoint<T>& point, const Vec3<T>& local, const Vec3<T>& world) {
  return point.flat ? abs(local.z) : abs(point.cosine(world));
}

// Where a subpath has arrived at a surface: what scattering there sees of it.
template <class T>
struct Arrival {
  SurfacePoint<T> point;
  Vec3<T> wi;  // local direction to the previous vertex
  T cosIn;     // |cos| of the same with the geometric normal

  Arrival() = default;
  // At the point that find() returns, in unit direction `direction`. (Points of duals are large: this way
  // they are made where they stay.)
  template <class Find>
  Arrival(const Vec3<T>& direction, Find&& find)
      : point(find()),
        wi(point.shading.toLocal(-direction)),
        cosIn(geometricCosine(point, wi, direction)) {}
};

// The line along which a ray has arrived. Vertices of duals do without: theirs is at hand where it is needed.
template <class T>
struct Line {
  Vec3<T> origin, direction;
};
struct NoLine {};

// The same with what the subpath brings along.
template <class T>
struct PathVertex : Arrival<T> {
  Rgb<T> throughput;
  T vcm, vc;
  [[no_unique_address]] std::conditional_t<ad::isDual<T>, NoLine, Line<T>> line;

  PathVertex() = default;
  // At the point that find() returns, which the ray is known to hit.
  template <class Find>
  PathVertex(const PathRay<T>& ray, Find&& find)
      : Arrival<T>(ray.direction, std::forward<Find>(find)), throughput(ray.throughput) {
    const T inverse = T(1) / this->cosIn;
    vcm = ray.vcm * inverse;
    if (!ray.fromInfinity) vcm = vcm * distance2(this->point.p, ray.origin);
    vc = ray.vc * inverse;
    if constexpr (!ad::isDual<T>) line = {ray.origin, ray.direction};
  }
};

// What a scattering does to the subpath, whatever the subpath brings along: onwards() applies it.
template <class T>
struct Scattering {
  Vec3<T> direction;  // unit, world space
  Rgb<T> factor;      // of the throughput; zero where nothing goes that way
  T vcm;              // of the ray; 0 for delta lobes
  T vc;               // the ray's is this * root((vertex.vc * reverse)^2 + vertex.vcm^2),
  T reverse;          // for delta lobes this * vertex.vc
  bool delta = false;
};

// sqrt(a^2 + b^2) where both are >= 0. No derivative of the root at 0 is ever needed: zeros are
// structural (delta lobes, delta lights) and decided by value. Where the squares, or the Hessian of the
// root, would leave float's range, both are first divided by the larger one.
template <class T>
T rootOfSquares(const T& a, const T& b) {
  if (value(b) == 0) return a;
  if (value(a) == 0) return b;
  using S = Scalar<T>;
  const S larger = std::max(value(a), value(b));
  if (larger > S(1e-6) && larger < S(1e6)) return sqrt(a * a + b * b);
  const S inverse = S(1) / larger;
  const T x = a * inverse, y = b * inverse;
  return sqrt(x * x + y * y) * larger;
}

inline const Material& materialAt(const Scene& scene, PrimitiveId id) {
  return scene.materials[at(scene.shapes[id.shape].material)];
}

// Calls f with the camera's pose: plain numbers where it stands still and is a pinhole, functions of time and of the
// point of its aperture otherwise.
template <class T, class F>
auto withCameraPose(const Scene& scene, const T* time, const T* aperture, F&& f) {
  if (scene.camera.moves() || scene.camera.hasAperture())
    return f(scene.camera.poseAt(time, aperture));
  return f(scene.camera.pose<Scalar<T>>());
}

// Not inlined: see arriveAt.
template <class T>
[[gnu::noinline]] PathRay<T> startCamera(const Scene& scene, const T& filmX, const T& filmY,
                                         const std::type_identity_t<T>* time = nullptr,
                                         const std::type_identity_t<T>* aperture = nullptr) {
  return withCameraPose<T>(scene, time, aperture, [&](const auto& pose) {
    PathRay<T> ray;
    ray.throughput = Rgb<T>(T(1));
    ray.vc = T(0);
    if (scene.camera.isParallel()) [[unlikely]] {
      ray.origin = scene.camera.origin(pose, filmX, filmY);
      ray.direction = liftFrom<T>(pose.forward);
      ray.vcm = T(Scalar<T>(scene.camera.filmArea()));
      ray.fromInfinity = true;
      return ray;
    }
    ray.origin = liftFrom<T>(pose.position);
    ray.direction = scene.camera.direction(pose, filmX, filmY);
    ray.vcm = T(1) / scene.camera.pdf(T(dot(pose.forward, ray.direction)));
    return ray;
  });
}

// A ray from light number `light` with the discrete choice `primitive` made; u places it, v directs
// it.
template <class T>
PathRay<T> startLight(const Scene& scene, int light, PrimitiveId primitive, const T& u0,
                      const T& u1, const T& v0, const T& v1,
                      const std::type_identity_t<T>* time = nullptr) {
  using S = Scalar<T>;
  const S pick = scene.emissionPicker.probability(light);
  const S direct = scene.directPicker.probability(light);
  return std::visit(
      [&](const auto& l) {
        const EmittedRay<T> e =
            sampleEmissionAt<T>(l, scene.lightContext(), primitive, u0, u1, v0, v1, time);
        PathRay<T> ray;
        ray.origin = e.origin;
        ray.direction = e.direction;
        // The frames that lights have are of unit length in float.
        if constexpr (std::is_same_v<S, double>) ray.direction = normalize(ray.direction);
        if constexpr (std::is_same_v<T, float>) ray.surface = {e.origin, e.normal, primitive.shape};
        const T inverse = T(1) / (e.emissionPdf * pick);
        ray.throughput = e.flux * (S(1) / pick);
        ray.vcm = e.directPdf * (direct / pick) / e.emissionPdf;
        ray.vc = l.isDelta() ? T(0) : e.cosLight * inverse;
        ray.fromInfinity = l.isInfinite();
        return ray;
      },
      scene.lights[at(light)]);
}

// One function, not inlined: compilers contract a b + c as its surroundings suggest, and a path that is
// replayed has to arrive where it was traced to.
template <class T>
[[gnu::noinline]] PathVertex<T> arriveAt(const Scene& scene, const PathRay<T>& ray, PrimitiveId id,
                                         const std::type_identity_t<T>* time = nullptr) {
  return PathVertex<T>(ray, [&] {
    SurfacePoint<T> point = intersectPrimitive(scene.shapes, id, ray.origin, ray.direction, time);
    if (const FrameMap* map = materialAt(scene, id).frame.get()) [[unlikely]]
      mapFrame<T>(*map, scene.shapes, id, -ray.direction, point, time);
    return point;
  });
}

// What light is multiplied by that is scattered to the local direction wo, at |cos| cosOut with the
// geometric normal: shading normals make scattering non-symmetric [Veach 1997, section 5.3].
template <class T>
Rgb<T> asImportance(const Arrival<T>& vertex, const Vec3<T>& wo, const T& cosOut,
                    const Rgb<T>& weight) {
  if (vertex.point.flat) return weight;
  return weight * T(abs(vertex.wi.z) * cosOut / (vertex.cosIn * abs(wo.z)));
}

// SurfacePoint::bendBlocks of a subpath that goes on in the world direction `onwards`.
template <class T>
bool bendBlocks(const Arrival<T>& vertex, const Vec3<T>& onwards, Side side) {
  if (vertex.point.bend == Bend::kNone) [[likely]]
    return false;
  const Vec3<T> back = vertex.point.shading.toWorld(vertex.wi);
  return side == Side::kCamera ? vertex.point.bendBlocks(onwards, back)
                               : vertex.point.bendBlocks(back, onwards);
}

// Scattering in the local direction `wo`, drawn with the density that the material has for it, all of
// its lobes but delta ones together.
template <class T>
Scattering<T> scatteringTowards(const Scene& scene, const Arrival<T>& vertex, PrimitiveId id,
                                const Vec3<T>& wo, Side side) {
  const Material& material = materialAt(scene, id);
  const Vec2<T>& uv = vertex.point.uv;
  Scattering<T> s;
  s.direction = vertex.point.shading.toWorld(wo);
  const T cosOut = geometricCosine(vertex.point, wo, s.direction);
  const SampledBsdf<T> e = sampledMaterial<T>(scene.bsdfs, material, uv, vertex.wi, wo);
  if (!(value(e.pdf) > 0) || bendBlocks(vertex, s.direction, side)) {
    s.factor = Rgb<T>(T(0));
    s.vcm = s.vc = s.reverse = T(0);
    return s;
  }
  s.factor = e.weight;
  if (side == Side::kLight)
    s.factor = asImportance(vertex, wo, cosOut, Rgb<T>(s.factor * e.importance));
  s.vcm = T(1) / e.pdf;
  s.vc = cosOut * s.vcm;
  s.reverse = e.pdfReverse;
  return s;
}

// Scattering through the delta lobe `lobe`.
template <class T>
Scattering<T> scatteringDelta(const Scene& scene, const Arrival<T>& vertex, PrimitiveId id,
                              LobeId lobe, Side side) {
  const DeltaSample<T> sample =
      sampleDelta<T>(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi, lobe);
  Scattering<T> s;
  s.delta = true;
  s.direction = vertex.point.shading.toWorld(sample.wo);
  const T cosOut = geometricCosine(vertex.point, sample.wo, s.direction);
  s.factor = side == Side::kCamera ? sample.radiance
                                   : asImportance(vertex, sample.wo, cosOut, sample.importance);
  if (bendBlocks(vertex, s.direction, side)) s.factor = Rgb<T>(T(Scalar<T>(0)));
  s.vcm = s.reverse = T(0);
  s.vc = cosOut;
  return s;
}

// Scattering through `lobe` in the direction that (u0, u1) draw.
template <class T>
Scattering<T> scatteringFrom(const Scene& scene, const Arrival<T>& vertex, PrimitiveId id,
                             LobeId lobe, const T& u0, const T& u1, Side side) {
  const Material& material = materialAt(scene, id);
  if (isDelta(scene.bsdfs, material, lobe)) return scatteringDelta(scene, vertex, id, lobe, side);
  const Vec3<T> wo =
      sampleMaterial<T>(scene.bsdfs, material, vertex.point.uv, vertex.wi, lobe, u0, u1);
  return scatteringTowards(scene, vertex, id, wo, side);
}

// Continues from a vertex. A throughput of zero means that nothing goes that way.
template <class T>
PathRay<T> onwards(const PathVertex<T>& vertex, const Scattering<T>& s) {
  PathRay<T> ray;
  ray.origin = vertex.point.p;
  if constexpr (std::is_same_v<T, float>) ray.surface = vertex.point.end();
  ray.direction = s.direction;
  ray.throughput = vertex.throughput * s.factor;
  ray.vcm = s.vcm;
  ray.vc = s.vc * (s.delta ? vertex.vc : rootOfSquares(T(vertex.vc * s.reverse), vertex.vcm));
  return ray;
}

// Straight on through the surface at `point`, where it is not opaque (LobeId::null), of the ray that has `arrived`
// there. It stays the line that it was, so that what it meets next loses no digits to a vertex that changes nothing
// but the throughput; the two cosines, being the same, leave no trace in vc.
template <class T>
PathRay<T> passThrough(const Scene& scene, const PathRay<T>& arrived, const SurfacePoint<T>& point,
                       PrimitiveId id) {
  PathRay<T> ray;
  ray.origin = arrived.origin;
  ray.direction = arrived.direction;
  ray.throughput = arrived.throughput * passingShare<T>(materialAt(scene, id), point.uv);
  ray.vcm = T(0);
  ray.vc = arrived.vc;
  if constexpr (std::is_same_v<T, float>) ray.surface = point.end();
  return ray;
}

// The steps with what the subpath brings along. Duals' null lobes are passThrough's.
template <class T>
PathRay<T> scatterTowards(const Scene& scene, const PathVertex<T>& vertex, PrimitiveId id,
                          const Vec3<T>& wo, Side side) {
  return onwards(vertex, scatteringTowards<T>(scene, vertex, id, wo, side));
}
template <class T>
PathRay<T> scatterFrom(const Scene& scene, const PathVertex<T>& vertex, PrimitiveId id, LobeId lobe,
                       const T& u0, const T& u1, Side side) {
  if constexpr (!ad::isDual<T>) {
    if (lobe.null) {
      PathRay<T> arrived;
      arrived.origin = vertex.line.origin;
      arrived.direction = vertex.line.direction;
      arrived.throughput = vertex.throughput;
      arrived.vc = vertex.vc * vertex.cosIn;
      return passThrough(scene, arrived, vertex.point, id);
    }
  }
  return onwards(vertex, scatteringFrom<T>(scene, vertex, id, lobe, u0, u1, side));
}

// A delta lobe at the vertex where the ray has `arrived`.
template <class T>
PathRay<T> scatterDelta(const Scene& scene, const PathRay<T>& arrived, const PathVertex<T>& vertex,
                        PrimitiveId id, LobeId lobe, Side side) {
  if (lobe.null) return passThrough(scene, arrived, vertex.point, id);
  return onwards(vertex, scatteringDelta<T>(scene, vertex, id, lobe, side));
}

}  // namespace h2mc
