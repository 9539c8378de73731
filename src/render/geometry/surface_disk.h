// Points on disks (ellipses, in general).
#pragma once

#include "render/core/safe_math.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// The point center + x axisX + y axisY.
template <class T>
SurfacePoint<T> diskPoint(const Disk& disk, const T& x, const T& y) {
  using S = Scalar<T>;
  SurfacePoint<T> r;
  const Vec3<S> ax = plain<T>(disk.axisX), ay = plain<T>(disk.axisY);
  r.p = {linear2(x, ax.x, y, ay.x), linear2(x, ax.y, y, ay.y), linear2(x, ax.z, y, ay.z)};
  r.p = withValue<T>(r.p, Vec3<S>(glm::dvec3(disk.center) +
                                  glm::dvec3(disk.axisX) * static_cast<double>(value(x)) +
                                  glm::dvec3(disk.axisY) * static_cast<double>(value(y))));
  const Vec3<S> normal = plain<T>(disk.normal);
  r.ng = lift<T>(normal);
  const Frame<S> frame = Frame<S>::fromNormal(normal);
  r.shading = {lift<T>(frame.s), lift<T>(frame.t), r.ng};
  r.uv = {safeSqrt(T(dot2(x, x, y, y))), turns(y, x)};
  return r;
}

// Vectors with dot(dual_i, axis_j) = delta_ij, for axes that need not be orthogonal.
template <class S>
void dualAxes(const Disk& disk, Vec3<S>& dualX, Vec3<S>& dualY) {
  const glm::dvec3 ax(disk.axisX), ay(disk.axisY), n = glm::cross(ax, ay);
  const double inverse = 1 / glm::dot(n, n);
  dualX = Vec3<S>(glm::cross(ay, n) * inverse);
  dualY = Vec3<S>(glm::cross(n, ax) * inverse);
}

template <class T>
SurfacePoint<T> intersectDisk(const Disk& disk, const Vec3<T>& origin, const Vec3<T>& direction) {
  using S = Scalar<T>;
  const Vec3<S> normal = plain<T>(disk.normal);
  const Vec3<T> start = origin - plain<T>(disk.center);
  const T t = -dot(start, normal) / dot(direction, normal);
  const Vec3<T> p = start + direction * t;
  Vec3<S> dualX, dualY;
  dualAxes<S>(disk, dualX, dualY);
  return diskPoint<T>(disk, dot(p, dualX), dot(p, dualY));
}

template <class T>
SurfacePoint<T> sampleDisk(const Disk& disk, const T& u0, const T& u1) {
  using S = Scalar<T>;
  T sinPhi, cosPhi;
  ad::sincos(T(u1 * S(2 * std::numbers::pi)), sinPhi, cosPhi);
  const T radius = safeSqrt(u0);
  return diskPoint<T>(disk, T(radius * cosPhi), T(radius * sinPhi));
}

}  // namespace h2mc::detail
