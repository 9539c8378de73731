// SPDX-License-Identifier: MIT
// Directions and points that several lights sample.
#pragma once

#include "render/core/safe_math.h"
#include "render/core/unit_interval.h"
#include "render/light/light_types.h"

namespace h2mc::detail {

// cos and sin of u turns.
template <class T>
Vec2<T> circle(const T& u) {
  T s, c;
  ad::sincos(T(u * Scalar<T>(2 * std::numbers::pi)), s, c);
  return {c, s};
}

// Uniform by area on the unit disk, u1 the angle.
template <class T>
Vec2<T> uniformDisk(const T& u0, const T& u1) {
  const T radius = safeSqrt(u0);
  const Vec2<T> c = circle(u1);
  return {radius * c.x, radius * c.y};
}
Vec2f invertUniformDisk(float x, float y);

// Uniform by solid angle on the sphere, u0 the azimuth.
template <class T>
Vec3<T> uniformSphere(const T& u0, const T& u1) {
  using S = Scalar<T>;
  const T rho = safeSqrt(T(u1 * (S(1) - u1))) * S(2);
  const Vec2<T> c = circle(u0);
  return {rho * c.x, rho * c.y, S(1) - u1 * S(2)};
}
Vec2f invertUniformSphere(const Vec3f& direction);

// A point of the disk on the scene's bounding sphere that faces an infinitely far light in
// direction `toLight`: where the rays of such lights start.
template <class T>
Vec3<T> diskTowards(const SceneBounds& bounds, const Vec3<T>& toLight, const T& u0, const T& u1) {
  using S = Scalar<T>;
  const Frame<T> frame = Frame<T>::fromNormal(toLight);
  const Vec2<T> d = uniformDisk(u0, u1);
  const S radius = S(bounds.radius);
  return (frame.s * d.x + frame.t * d.y + toLight) * radius + plain<T>(bounds.center);
}
// The same for a direction that does not depend on the coordinates.
template <class T>
Vec3<T> passiveDiskTowards(const SceneBounds& bounds, const Vec3<Scalar<T>>& toLight, const T& u0,
                           const T& u1) {
  using S = Scalar<T>;
  const Frame<S> frame = Frame<S>::fromNormal(toLight);
  const Vec2<T> d = uniformDisk(u0, u1);
  const S radius = S(bounds.radius);
  return ad::combine(d.x, Vec3<S>(frame.s * radius), d.y, Vec3<S>(frame.t * radius), T(S(1)),
                     Vec3<S>(toLight * radius + plain<T>(bounds.center)));
}
// The coordinates of the ray through `point`; false when it misses the disk.
bool invertDiskTowards(const SceneBounds& bounds, const Vec3f& toLight, const Vec3f& point,
                       Vec2f& u);

template <class S>
S diskPdf(const SceneBounds& bounds) {
  return S(1) / (S(kPi) * S(bounds.radius) * S(bounds.radius));
}

// Distance that stands for infinitely far.
inline float beyond(const SceneBounds& bounds) { return 4 * bounds.radius; }

// A colour as passive values of T.
template <class T>
Rgb<T> passiveColor(const Rgbf& c) {
  return lift<T>(plain<T>(c));
}

// What lights that are infinitely far have in common. pdf: of the drawn direction `toLight`, per
// solid angle; arriving: radiance over that.
template <class T>
DirectLight<T> directFromInfinity(const SceneBounds& bounds, const Vec3<T>& toLight, const T& pdf,
                                  const Rgb<T>& arriving) {
  using S = Scalar<T>;
  DirectLight<T> r;
  r.direction = toLight;
  r.distance = T(S(beyond(bounds)));
  r.arriving = arriving;
  r.directPdf = pdf;
  r.emissionPdf = pdf * diskPdf<S>(bounds);
  r.cosLight = T(S(1));
  return r;
}
// u0, u1: where the ray begins.
template <class T>
EmittedRay<T> emittedFromInfinity(const SceneBounds& bounds, const Vec3<T>& toLight, const T& pdf,
                                  const Rgb<T>& arriving, const T& u0, const T& u1) {
  using S = Scalar<T>;
  EmittedRay<T> r;
  r.origin = diskTowards(bounds, toLight, u0, u1);
  r.direction = -toLight;
  r.normal = lift<T>(Vec3<S>(0));
  r.flux = arriving * (S(1) / diskPdf<S>(bounds));
  r.directPdf = pdf;
  r.emissionPdf = pdf * diskPdf<S>(bounds);
  r.cosLight = T(S(1));
  return r;
}

// Whether `p` is the point `at` up to rounding, `distance` away from where it was reckoned.
inline bool isNear(const Vec3f& p, const Vec3f& at, float distance) {
  const Vec3f d = p - at;
  const float tolerance = 1e-4f * (distance + glm::length(at));
  return dot(d, d) <= tolerance * tolerance;
}

// What no path can hit.
template <class T>
LightHit<T> noHit() {
  using S = Scalar<T>;
  return {lift<T>(Vec3<S>(0)), T(S(0)), T(S(0))};
}

// Light from a point; emit(r, 1 / distance^2) sets what arrives and emissionPdf, knowing the direction.
template <class T, class Emit>
DirectLight<T> directFromPoint(const Vec3f& position, const Vec3<T>& reference, Emit&& emit) {
  using S = Scalar<T>;
  DirectLight<T> r;
  r.position = plain<T>(position);
  const Vec3<T> offset = -(reference - r.position);
  r.directPdf = ad::length2(offset);
  r.cosLight = T(S(1));
  if (!(value(r.directPdf) > std::numeric_limits<S>::min())) {
    r.direction = lift<T>(Vec3<S>(0, 0, 1));
    r.arriving = lift<T>(Vec3<S>(0));
    r.distance = r.directPdf = r.emissionPdf = T(S(0));
    return r;
  }
  const T inverse = ad::rsqrt(r.directPdf);
  r.distance = r.directPdf * inverse;
  r.direction = offset * inverse;
  emit(r, T(inverse * inverse));
  return r;
}

}  // namespace h2mc::detail
