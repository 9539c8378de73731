// SPDX-License-Identifier: MIT
// Points on spheres.
#pragma once

#include "render/core/direction_chart.h"
#include "render/core/index.h"
#include "render/core/safe_math.h"
#include "render/geometry/moment.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// A sphere with parameters of P: plain numbers where it stands still, functions of time where it
// moves.
template <class P>
struct SphereView {
  Vec3<P> center;
  P radius;
  bool flipNormals;
  Vec3<P> toLocal[3];      // rows
  glm::dvec3 exactCenter;  // value of `center`
};

template <class S>
SphereView<S> viewOf(const Sphere& sphere) {
  const glm::mat3& m = sphere.toLocal;
  const auto row = [&](int i) { return Vec3<S>(S(m[0][i]), S(m[1][i]), S(m[2][i])); };
  return {Vec3<S>(sphere.center),
          S(sphere.radius),
          sphere.flipNormals,
          {row(0), row(1), row(2)},
          glm::dvec3(sphere.center)};
}

template <class T>
SphereView<T> viewOf(const MovingSphere& sphere, const T& time) {
  const auto moment = Moment<T>::at(static_cast<int>(sphere.steps.size()) - 1, time);
  const Sphere &a = sphere.steps[at(moment.index)], &b = sphere.steps[at(moment.index) + 1];
  const auto row = [&](int i) {
    return moment.between(Vec3f(a.toLocal[0][i], a.toLocal[1][i], a.toLocal[2][i]),
                          Vec3f(b.toLocal[0][i], b.toLocal[1][i], b.toLocal[2][i]));
  };
  return {moment.between(a.center, b.center),
          moment.between(Scalar<T>(a.radius), Scalar<T>(b.radius)),
          a.flipNormals,
          {row(0), row(1), row(2)},
          moment.exactlyBetween(a.center, b.center)};
}

// The point in direction `n` (unit) from the centre.
template <class T, class P>
SurfacePoint<T> spherePoint(const SphereView<P>& sphere, const Vec3<T>& n) {
  using S = Scalar<T>;
  SurfacePoint<T> r;
  // The value in double: where the sphere is large and far from the origin but p is not, the sum's
  // rounding must not lift p off the surface.
  glm::dvec3 outward(value3(n));
  outward *= static_cast<double>(value(sphere.radius)) / std::sqrt(glm::dot(outward, outward));
  r.p = n * sphere.radius;
  if constexpr (ad::isDual<P>) r.p = r.p + sphere.center;
  setValue(r.p, Vec3<S>(sphere.exactCenter + outward));
  r.ng = sphere.flipNormals ? -n : n;
  r.shading = Frame<T>::fromNormal(r.ng);
  r.flat = true;

  const auto local = [&](int i) -> T { return dot(n, sphere.toLocal[i]); };
  const T x = local(0), y = local(1), z = local(2);
  const T rho = safeSqrt(T(dot2(x, x, y, y)));
  r.uv = {turns(y, x), ad::atan2(rho, z) * S(std::numbers::inv_pi)};
  return r;
}

// The unit vector from the centre to where a line meets the sphere. root 0: the nearer, 1: the farther
// intersection. The line is taken to touch where it misses by rounding.
template <class T, class P>
Vec3<T> meetSphere(const SphereView<P>& sphere, std::uint32_t root, const Vec3<T>& origin,
                   const Vec3<T>& direction, T& distance) {
  using S = Scalar<T>;
  const P& radius = sphere.radius;
  const Vec3<T> start = origin - sphere.center;
  const T closest = -dot(start, direction);
  // From the perpendicular to the line: b^2 - 4ac cancels for small, far spheres.
  const Vec3<T> perpendicular = start + direction * closest;
  const T discriminant =
      (radius * radius - ad::length2(perpendicular)) * (P(S(1)) / (radius * radius));
  const T half = safeSqrt(discriminant) * radius;
  const bool farRootIsLarger = value(closest) >= 0;
  const T larger = farRootIsLarger ? T(closest + half) : T(closest - half);
  distance = larger;
  if ((root == 1) != farRootIsLarger && value(larger) != 0) {
    // The product of the roots: no cancellation where the origin lies on the sphere.
    distance = (ad::length2(start) - radius * radius) / larger;
  }
  return ad::normalize(Vec3<T>(start + direction * distance));
}

template <class T, class P>
SurfacePoint<T> intersectSphere(const SphereView<P>& sphere, std::uint32_t root,
                                const Vec3<T>& origin, const Vec3<T>& direction) {
  T distance;
  return spherePoint<T>(sphere, meetSphere<T>(sphere, root, origin, direction, distance));
}

// Directions near the one from the centre to the point `around`.
template <class P>
DirectionChart<Scalar<P>> chartAround(const SphereView<P>& sphere, const Vec3<Scalar<P>>& around) {
  return DirectionChart<Scalar<P>>(glm::normalize(around - Vec3<Scalar<P>>(sphere.exactCenter)));
}

template <class T, class P>
SurfacePoint<T> sampleSphere(const SphereView<P>& sphere, const T& u0, const T& u1) {
  using S = Scalar<T>;
  T sinPhi, cosPhi;
  ad::sincos(T(u1 * S(2 * std::numbers::pi)), sinPhi, cosPhi);
  const T rho = safeSqrt(T(u0 * (S(1) - u0))) * S(2);
  return spherePoint<T>(sphere, Vec3<T>(rho * cosPhi, rho * sinPhi, S(1) - u0 * S(2)));
}

}  // namespace h2mc::detail
