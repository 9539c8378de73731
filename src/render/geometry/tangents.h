// SPDX-License-Identifier: MIT
// How a surface's points follow its texture coordinates.
#pragma once

#include <numbers>

#include "render/geometry/surface.h"

namespace h2mc {

// dp/du and dp/dv, in the world's units; both zero where the texture coordinates say none.
template <class T>
struct Tangents {
  Vec3<T> u, v;
};

namespace detail {

template <class T, class View>
Tangents<T> triangleTangents(const View& mesh, std::uint32_t index) {
  using S = Scalar<T>;
  const auto triangle = triangleOf(mesh, index);
  const Vec3<T> e1 = liftFrom<T>(triangle.e1), e2 = liftFrom<T>(triangle.e2);
  if (!mesh.hasUvs()) return {e1, e2};
  const glm::uvec3& t = mesh.triangle(index);
  const glm::dvec2 a(mesh.uv(t.x)), d1 = glm::dvec2(mesh.uv(t.y)) - a,
                                    d2 = glm::dvec2(mesh.uv(t.z)) - a;
  const double determinant = d1.x * d2.y - d1.y * d2.x;
  if (!(std::abs(determinant) > 1e-30)) return {Vec3<T>(T(S(0))), Vec3<T>(T(S(0)))};
  const auto over = [&](double x) { return S(x / determinant); };
  return {e1 * over(d2.y) - e2 * over(d1.y), e2 * over(d1.x) - e1 * over(d2.x)};
}

// u = azimuth / 2 pi, v = angle to the local z axis / pi.
template <class T, class P>
Tangents<T> sphereTangents(const SphereView<P>& sphere, const SurfacePoint<T>& point) {
  using S = Scalar<T>;
  constexpr S kPiOf = std::numbers::pi_v<S>;
  const Vec3<T> n = sphere.flipNormals ? -point.ng : point.ng;
  const auto local = [&](int i) -> T { return dot(n, sphere.toLocal[i]); };
  const T x = local(0), y = local(1), z = local(2);
  const T rho = safeSqrt(T(dot2(x, x, y, y)));
  if (!(value(rho) > S(1e-6))) return {Vec3<T>(T(S(0))), Vec3<T>(T(S(0)))};
  const Vec3<T> ax = liftFrom<T>(sphere.toLocal[0]), ay = liftFrom<T>(sphere.toLocal[1]),
                az = liftFrom<T>(sphere.toLocal[2]);
  const T inverse = T(S(1)) / rho;
  const Vec3<T> along = (ax * x + ay * y) * inverse;  // unit, away from the axis
  const T radius(sphere.radius);
  return {(ay * x - ax * y) * T(radius * (S(2) * kPiOf)),
          (along * z - az * rho) * T(radius * kPiOf)};
}

// u = azimuth / 2 pi, v = share of the height.
template <class T, class P>
Tangents<T> cylinderTangents(const CylinderView<P>& view, const SurfacePoint<T>& point) {
  using S = Scalar<T>;
  const Vec3<T> n = view.flipNormals ? -point.ng : point.ng, axis = liftFrom<T>(view.axis);
  return {cross(axis, n) * T(T(view.radius) * S(2 * std::numbers::pi)), axis * T(view.height)};
}

// u = distance from the centre, v = azimuth / 2 pi.
template <class T, class P>
Tangents<T> diskTangents(const DiskView<P>& disk, const SurfacePoint<T>& point) {
  using S = Scalar<T>;
  constexpr S kTurn = 2 * std::numbers::pi_v<S>;
  T sine, cosine;
  ad::sincos(T(point.uv.y * kTurn), sine, cosine);
  const Vec3<T> ax = liftFrom<T>(disk.axisX), ay = liftFrom<T>(disk.axisY);
  return {ax * cosine + ay * sine, (ay * cosine - ax * sine) * T(point.uv.x * kTurn)};
}

}  // namespace detail

// At a point of the primitive. `time` as in surface.h.
template <class T>
Tangents<T> tangentsOnPrimitive(std::span<const Shape> shapes, PrimitiveId id,
                                const SurfacePoint<T>& point,
                                const std::type_identity_t<T>* time = nullptr) {
  return detail::withView<T>(shapes[id.shape], time, [&](const auto& view) -> Tangents<T> {
    if constexpr (requires { view.height; })
      return detail::cylinderTangents<T>(view, point);
    else if constexpr (requires { view.radius; })
      return detail::sphereTangents<T>(view, point);
    else if constexpr (requires { view.axisX; })
      return detail::diskTangents<T>(view, point);
    else
      return detail::triangleTangents<T>(view, id.primitive);
  });
}

}  // namespace h2mc
