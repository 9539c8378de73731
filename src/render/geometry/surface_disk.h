// SPDX-License-Identifier: MIT
// Points on disks (ellipses, in general).
#pragma once

#include "render/core/index.h"
#include "render/core/safe_math.h"
#include "render/geometry/moment.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// A disk with parameters of P: plain numbers where it stands still, functions of time where it
// moves.
template <class P>
struct DiskView {
  Vec3<P> center, axisX, axisY, normal;
  glm::dvec3 exactCenter, exactX, exactY;  // values
};

template <class S>
DiskView<S> viewOf(const Disk& disk) {
  return {Vec3<S>(disk.center),  Vec3<S>(disk.axisX),     Vec3<S>(disk.axisY),
          Vec3<S>(disk.normal),  glm::dvec3(disk.center), glm::dvec3(disk.axisX),
          glm::dvec3(disk.axisY)};
}

template <class T>
DiskView<T> viewOf(const MovingDisk& disk, const T& time) {
  const auto moment = Moment<T>::at(static_cast<int>(disk.steps.size()) - 1, time);
  const Disk &a = disk.steps[at(moment.index)], &b = disk.steps[at(moment.index) + 1];
  DiskView<T> r;
  r.center = moment.between(a.center, b.center);
  r.axisX = moment.between(a.axisX, b.axisX);
  r.axisY = moment.between(a.axisY, b.axisY);
  r.exactCenter = moment.exactlyBetween(a.center, b.center);
  r.exactX = moment.exactlyBetween(a.axisX, b.axisX);
  r.exactY = moment.exactlyBetween(a.axisY, b.axisY);
  // Across the axes, on the side that the disk has: scaled to 1 before it is squared.
  using S = Scalar<T>;
  const glm::dvec3 across = glm::cross(r.exactX, r.exactY);
  const double side = glm::dot(across, glm::dvec3(a.normal)) < 0 ? -1 : 1;
  const S scale = S(side / std::max(std::sqrt(glm::dot(across, across)), 1e-30));
  r.normal = ad::normalize(Vec3<T>(cross(r.axisX, r.axisY) * scale));
  return r;
}

// The point center + x axisX + y axisY.
template <class T, class P>
SurfacePoint<T> diskPoint(const DiskView<P>& disk, const T& x, const T& y) {
  using S = Scalar<T>;
  SurfacePoint<T> r;
  const Vec3<P>&ax = disk.axisX, &ay = disk.axisY;
  r.p = {weighted2(x, ax.x, y, ay.x), weighted2(x, ax.y, y, ay.y), weighted2(x, ax.z, y, ay.z)};
  if constexpr (ad::isDual<P>) r.p = r.p + disk.center;
  setValue(r.p, Vec3<S>(disk.exactCenter + disk.exactX * static_cast<double>(value(x)) +
                        disk.exactY * static_cast<double>(value(y))));
  r.ng = liftFrom<T>(disk.normal);
  r.shading.assign(Frame<P>::fromNormal(disk.normal));
  r.flat = true;
  r.constantNormal = !ad::isDual<P>;
  r.uv = {safeSqrt(T(dot2(x, x, y, y))), turns(y, x)};
  return r;
}

// Vectors with dot(dual_i, axis_j) = delta_ij, for axes that need not be orthogonal.
template <class P>
void dualAxes(const DiskView<P>& disk, Vec3<P>& dualX, Vec3<P>& dualY) {
  const glm::dvec3 n = glm::cross(disk.exactX, disk.exactY);
  if constexpr (ad::isDual<P>) {
    // Scaled to 1 before it is squared, as above.
    using S = Scalar<P>;
    const S scale = S(1 / std::max(std::sqrt(glm::dot(n, n)), 1e-30));
    const Vec3<P> unit = cross(disk.axisX, disk.axisY) * scale;
    const P inverse = (P(S(1)) / length2(unit)) * scale;
    dualX = cross(disk.axisY, unit) * inverse;
    dualY = cross(unit, disk.axisX) * inverse;
  } else {
    const double inverse = 1 / glm::dot(n, n);
    dualX = Vec3<P>(glm::cross(disk.exactY, n) * inverse);
    dualY = Vec3<P>(glm::cross(n, disk.exactX) * inverse);
  }
}

// Coordinates along the axes where a line meets the disk's plane.
template <class T, class P>
Vec2<T> diskCoordinates(const DiskView<P>& disk, const Vec3<T>& origin, const Vec3<T>& direction,
                        T& distance) {
  const Vec3<T> start = origin - disk.center;
  distance = -dot(start, disk.normal) / dot(direction, disk.normal);
  const Vec3<T> p = start + direction * distance;
  Vec3<P> dualX, dualY;
  dualAxes<P>(disk, dualX, dualY);
  return {dot(p, dualX), dot(p, dualY)};
}

template <class T, class P>
SurfacePoint<T> intersectDisk(const DiskView<P>& disk, const Vec3<T>& origin,
                              const Vec3<T>& direction) {
  T distance;
  const Vec2<T> at = diskCoordinates<T>(disk, origin, direction, distance);
  return diskPoint<T>(disk, at.x, at.y);
}

template <class T, class P>
SurfacePoint<T> sampleDisk(const DiskView<P>& disk, const T& u0, const T& u1) {
  using S = Scalar<T>;
  T sinPhi, cosPhi;
  ad::sincos(T(u1 * S(2 * std::numbers::pi)), sinPhi, cosPhi);
  const T radius = safeSqrt(u0);
  return diskPoint<T>(disk, T(radius * cosPhi), T(radius * sinPhi));
}

}  // namespace h2mc::detail
