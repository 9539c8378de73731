// SPDX-License-Identifier: MIT
#pragma once

#include "render/core/distribution.h"
#include "render/core/hemisphere.h"
#include "render/core/index.h"
#include "render/geometry/surface.h"
#include "render/light/light_sampling.h"
#include "render/scene/plugin.h"
#include "render/texture/texture.h"

namespace h2mc {

// A shape that emits the same radiance in all directions, on the side of its normal. A texture may
// vary the radiance; points are sampled uniformly by area all the same.
//
// On a shape that moves, a triangle is chosen by its mean area and a point uniformly on it as it is at
// the moment. `time`, null otherwise, is that moment.
struct AreaLight {
  TexturePtr radiance;
  int shape = -1;  // index of the shape that emits, set when the scene is read

  // Call when `shape` is set and the shapes are in place, before anything else.
  void prepare(std::span<const Shape> shapes);

  bool isDelta() const { return false; }
  bool isInfinite() const { return false; }
  bool isEnvironment() const { return false; }
  float power(const SceneBounds&) const;  // std::logic_error before prepare()

  template <class T>
  DirectLight<T> sampleDirect(const LightContext& context, PrimitiveId primitive,
                              const Vec3<T>& reference, const T& u0, const T& u1,
                              const T* time = nullptr) const;
  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId primitive, const T& u0,
                               const T& u1, const T& v0, const T& v1,
                               const T* time = nullptr) const;
  template <class T>
  LightHit<T> hit(const LightContext& context, const SurfacePoint<T>& point,
                  const Vec3<T>& direction, PrimitiveId primitive = {},
                  const T* time = nullptr) const;

  PrimitiveId choosePrimitive(const LightContext& context, float choice) const;
  bool invertDirect(const LightContext& context, PrimitiveId primitive, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice,
                    const float* time = nullptr) const;
  bool invertEmission(const LightContext& context, PrimitiveId primitive, const Vec3f& origin,
                      const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice,
                      const float* time = nullptr) const;
  unsigned wrapsDirect(const LightContext&) const { return wraps_ ? 2u : 0u; }
  unsigned wrapsEmission(const LightContext&) const { return wraps_ ? 10u : 8u; }

 private:
  // What densities per area are multiplied by because the shape moves.
  template <class T>
  T densityFactor(const LightContext& context, PrimitiveId primitive, const T& time) const;

  DiscreteDistribution triangles_;  // by area; empty for shapes that are sampled whole
  float area_ = 0;                  // until prepare()
  bool wraps_ = false;
  bool moving_ = false;
};

template <class T>
T AreaLight::densityFactor(const LightContext& context, PrimitiveId primitive,
                           const T& time) const {
  using S = Scalar<T>;
  const Shape& s = context.shapes[at(shape)];
  const int index = static_cast<int>(primitive.primitive);
  const S chosen = triangles_.size() > 0 ? S(triangles_.probability(index)) : S(1);
  return T(chosen * S(area_)) / primitiveAreaAt<T>(s, primitive.primitive, &time);
}

// For what lights return.
template <class Sampled, class T>
void scaleDensities(Sampled& r, const T& factor) {
  r.directPdf = r.directPdf * factor;
  r.emissionPdf = r.emissionPdf * factor;
}

template <class T>
DirectLight<T> AreaLight::sampleDirect(const LightContext& context, PrimitiveId primitive,
                                       const Vec3<T>& reference, const T& u0, const T& u1,
                                       const T* time) const {
  using S = Scalar<T>;
  const SurfacePoint<T> point = samplePrimitive<T>(context.shapes, primitive, u0, u1, time);
  DirectLight<T> r;
  r.position = value3(point.p);
  r.normal = value3(point.ng);
  const Vec3<T> offset = point.p - reference;
  const T distance2 = ad::length2(offset);
  const S cosine = -dot(value3(offset), r.normal);
  if (!(value(distance2) > std::numeric_limits<S>::min())) {
    r.direction = -point.ng;
    r.distance = r.directPdf = r.emissionPdf = T(S(0));
    r.arriving = lift<T>(Vec3<S>(0));
    r.cosLight = T(S(1));
    return r;
  }
  const T inverse = ad::rsqrt(distance2);
  r.direction = offset * inverse;
  r.distance = distance2 * inverse;
  const T cosLight = point.cosine(r.direction);
  r.cosLight = cosine < 0 ? cosLight : T(-cosLight);
  // Edge on: no density per solid angle. Held at a value that keeps quotients finite.
  if (value(r.cosLight) < S(1e-7)) r.cosLight = T(S(1e-7));
  r.directPdf = distance2 / (r.cosLight * S(area_));
  T seen = r.cosLight * inverse * inverse * S(area_);
  if (moving_) {
    const T factor = densityFactor(context, primitive, *time);
    r.directPdf = r.directPdf * factor;
    seen = seen / factor;
    r.emissionPdf = r.cosLight * factor * S(kInvPi / area_);
  } else {
    r.emissionPdf = r.cosLight * S(kInvPi / area_);
  }
  if (cosine > 0) {
    r.arriving = modulate<T>(*radiance, point.uv, seen);
  } else {
    r.arriving = lift<T>(Vec3<S>(0));
    r.emissionPdf = T(S(0));
  }
  return r;
}

template <class T>
EmittedRay<T> AreaLight::sampleEmission(const LightContext& context, PrimitiveId primitive,
                                        const T& u0, const T& u1, const T& v0, const T& v1,
                                        const T* time) const {
  using S = Scalar<T>;
  const SurfacePoint<T> point = samplePrimitive<T>(context.shapes, primitive, u0, u1, time);
  const Vec3<T> local = sampleCosine<T>(v0, v1);
  EmittedRay<T> r;
  r.cosLight = local.z;
  r.origin = point.p;
  r.normal = point.ng;
  if (point.constantNormal) {
    const Frame<S> frame = Frame<S>::fromNormal(value3(point.ng));
    r.direction = ad::combine(local.x, frame.s, local.y, frame.t, local.z, frame.n);
  } else {
    r.direction = Frame<T>::fromNormal(point.ng).toWorld(local);
  }
  r.emissionPdf = r.cosLight * S(kInvPi / area_);
  r.directPdf = T(S(1 / area_));
  T etendue = T(S(kPi * area_));
  if (moving_) {
    const T factor = densityFactor(context, primitive, *time);
    scaleDensities(r, factor);
    etendue = etendue / factor;
  }
  r.flux = modulate<T>(*radiance, point.uv, etendue);
  return r;
}

template <class T>
LightHit<T> AreaLight::hit(const LightContext& context, const SurfacePoint<T>& point,
                           const Vec3<T>& direction, PrimitiveId primitive, const T* time) const {
  using S = Scalar<T>;
  LightHit<T> r;
  r.directPdf = T(S(1 / area_));
  const T cosine = -point.cosine(direction);
  if (value(cosine) > 0) {
    r.radiance = evaluate<T>(*radiance, point.uv);
    r.emissionPdf = cosine * S(kInvPi / area_);
  } else {
    r.radiance = lift<T>(Vec3<S>(0));
    r.emissionPdf = T(S(0));
  }
  if (moving_) scaleDensities(r, densityFactor(context, primitive, *time));
  return r;
}

}  // namespace h2mc
