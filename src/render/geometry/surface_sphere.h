// Points on spheres.
#pragma once

#include "render/core/safe_math.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// The point in direction `n` (unit) from the centre.
template <class T>
SurfacePoint<T> spherePoint(const Sphere& sphere, const Vec3<T>& n) {
  using S = Scalar<T>;
  SurfacePoint<T> r;
  // The value in double: where the sphere is large and far from the origin but p is not, the sum's
  // rounding must not lift p off the surface.
  glm::dvec3 outward(value3(n));
  outward *= static_cast<double>(sphere.radius) / std::sqrt(glm::dot(outward, outward));
  r.p = withValue<T>(n * S(sphere.radius), Vec3<S>(glm::dvec3(sphere.center) + outward));
  r.ng = sphere.flipNormals ? -n : n;
  r.shading = Frame<T>::fromNormal(r.ng);

  const auto local = [&](int i) -> T {
    const glm::mat3& m = sphere.toLocal;
    return dot(n, Vec3<S>(S(m[0][i]), S(m[1][i]), S(m[2][i])));
  };
  const T x = local(0), y = local(1), z = local(2);
  const T rho = safeSqrt(T(dot2(x, x, y, y)));
  r.uv = {turns(y, x), ad::atan2(rho, z) * S(std::numbers::inv_pi)};
  return r;
}

// root 0: the nearer, 1: the farther intersection along the line. The line is taken to touch where
// it misses by rounding.
template <class T>
SurfacePoint<T> intersectSphere(const Sphere& sphere, std::uint32_t root, const Vec3<T>& origin,
                                const Vec3<T>& direction) {
  using S = Scalar<T>;
  const S radius = S(sphere.radius);
  const Vec3<T> start = origin - plain<T>(sphere.center);
  const T closest = -dot(start, direction);
  // From the perpendicular to the line: b^2 - 4ac cancels for small, far spheres.
  const Vec3<T> perpendicular = start + direction * closest;
  const T discriminant = (radius * radius - ad::length2(perpendicular)) * (1 / (radius * radius));
  const T half = safeSqrt(discriminant) * radius;
  const bool farRootIsLarger = value(closest) >= 0;
  const T larger = farRootIsLarger ? T(closest + half) : T(closest - half);
  T t = larger;
  if ((root == 1) != farRootIsLarger && value(larger) != 0) {
    // The product of the roots: no cancellation where the origin lies on the sphere.
    t = (ad::length2(start) - radius * radius) / larger;
  }
  return spherePoint<T>(sphere, ad::normalize(Vec3<T>(start + direction * t)));
}

template <class T>
SurfacePoint<T> sampleSphere(const Sphere& sphere, const T& u0, const T& u1) {
  using S = Scalar<T>;
  T sinPhi, cosPhi;
  ad::sincos(T(u1 * S(2 * std::numbers::pi)), sinPhi, cosPhi);
  const T rho = safeSqrt(T(u0 * (S(1) - u0))) * S(2);
  return spherePoint<T>(sphere, Vec3<T>(rho * cosPhi, rho * sinPhi, S(1) - u0 * S(2)));
}

}  // namespace h2mc::detail
