// SPDX-License-Identifier: MIT
// Points on open cylinders.
#pragma once

#include "render/core/index.h"
#include "render/core/safe_math.h"
#include "render/geometry/moment.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// A cylinder with parameters of P: plain numbers where it stands still, functions of time where it
// moves. Right and circular at every moment.
template <class P>
struct CylinderView {
  Vec3<P> start, axis;  // the first end's centre; unit, towards the other one
  Vec3<P> x, y;         // unit, across: azimuth 0 and a quarter turn
  P height, radius;
  bool flipNormals;
  glm::dvec3 exactStart, exactAxis;  // values
  double exactHeight, exactRadius;
};

namespace cylinder {

// Sets axis, x, y and height from `way`, which leads from end to end, and a direction that x is near to.
template <class P>
void setFrame(CylinderView<P>& view, const Vec3<P>& way, const Vec3<P>& nearX) {
  using S = Scalar<P>;
  const Vec3<S> v = value3(way);
  const S scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), S(1e-30)});
  const Vec3<P> unit = way * (S(1) / scale);  // of about length 1, whatever the units
  const P length = ad::sqrt(ad::length2(unit));
  view.axis = unit * P(P(S(1)) / length);
  view.height = length * scale;
  view.x = ad::normalize(Vec3<P>(nearX - view.axis * dot(nearX, view.axis)));
  view.y = cross(view.axis, view.x);
}

template <class P>
void setExact(CylinderView<P>& view, const glm::dvec3& start, const glm::dvec3& way,
              double radius) {
  view.exactStart = start;
  view.exactHeight = glm::length(way);
  view.exactAxis = way / std::max(view.exactHeight, 1e-300);
  view.exactRadius = radius;
}

}  // namespace cylinder

template <class S>
CylinderView<S> viewOf(const Cylinder& c) {
  CylinderView<S> r;
  r.start = Vec3<S>(c.start);
  r.radius = S(c.radius);
  r.flipNormals = c.flipNormals;
  cylinder::setFrame<S>(r, Vec3<S>(c.end) - Vec3<S>(c.start), Vec3<S>(c.axisX));
  cylinder::setExact(r, glm::dvec3(c.start), glm::dvec3(c.end) - glm::dvec3(c.start),
                     static_cast<double>(c.radius));
  return r;
}

template <class T>
CylinderView<T> viewOf(const MovingCylinder& moving, const T& time) {
  using S = Scalar<T>;
  const auto moment = Moment<T>::at(static_cast<int>(moving.steps.size()) - 1, time);
  const Cylinder &a = moving.steps[at(moment.index)], &b = moving.steps[at(moment.index) + 1];
  CylinderView<T> r;
  r.start = moment.between(a.start, b.start);
  r.radius = moment.between(S(a.radius), S(b.radius));
  r.flipNormals = a.flipNormals;
  cylinder::setFrame<T>(r, Vec3<T>(moment.between(a.end, b.end) - r.start),
                        moment.between(a.axisX, b.axisX));
  const glm::dvec3 start = moment.exactlyBetween(a.start, b.start);
  cylinder::setExact(r, start, moment.exactlyBetween(a.end, b.end) - start,
                     static_cast<double>(value(r.radius)));
  return r;
}

// The point in direction `n` (unit, across the axis) from the axis at the share z of the height.
template <class T, class P>
SurfacePoint<T> cylinderPoint(const CylinderView<P>& view, const Vec3<T>& n, const T& z) {
  using S = Scalar<T>;
  SurfacePoint<T> r;
  // The value in double, as the sphere's.
  glm::dvec3 outward(value3(n));
  outward -= view.exactAxis * glm::dot(outward, view.exactAxis);
  outward *= view.exactRadius / std::sqrt(glm::dot(outward, outward));
  const T along = z * view.height;
  r.p = n * view.radius;
  for (int i = 0; i < 3; ++i) r.p[i] = r.p[i] + along * view.axis[i];
  if constexpr (ad::isDual<P>) r.p = r.p + view.start;
  setValue(r.p, Vec3<S>(view.exactStart + outward +
                        view.exactAxis * (static_cast<double>(value(z)) * view.exactHeight)));
  r.ng = view.flipNormals ? -n : n;
  r.shading = Frame<T>::fromNormal(r.ng);
  r.flat = true;
  r.uv = {turns(T(dot(n, view.y)), T(dot(n, view.x))), z};
  return r;
}

// Where a line meets the endless cylinder: the unit vector away from the axis, and the share of the height.
// root 0: the nearer, 1: the farther intersection. The line is taken to touch where it misses by rounding.
template <class T, class P>
Vec3<T> meetCylinder(const CylinderView<P>& view, std::uint32_t root, const Vec3<T>& origin,
                     const Vec3<T>& direction, T& distance, T& z) {
  using S = Scalar<T>;
  const P& radius = view.radius;
  const Vec3<T> start = origin - view.start;
  const T startAlong = dot(start, view.axis), directionAlong = dot(direction, view.axis);
  Vec3<T> across = start, d = direction;
  for (int i = 0; i < 3; ++i) {
    across[i] = across[i] - startAlong * view.axis[i];
    d[i] = d[i] - directionAlong * view.axis[i];
  }
  const T d2 = ad::length2(d);
  const T closest = -dot(across, d) / d2;
  const Vec3<T> perpendicular = across + d * closest;
  const T discriminant =
      (radius * radius - ad::length2(perpendicular)) * (P(S(1)) / (radius * radius));
  const T half = safeSqrt(discriminant) * radius / ad::sqrt(d2);
  const bool farRootIsLarger = value(closest) >= 0;
  const T larger = farRootIsLarger ? T(closest + half) : T(closest - half);
  distance = larger;
  if ((root == 1) != farRootIsLarger && value(larger) != 0) {
    // The product of the roots: no cancellation where the origin lies on the cylinder.
    distance = (ad::length2(across) - radius * radius) / (larger * d2);
  }
  z = (startAlong + distance * directionAlong) * (P(S(1)) / view.height);
  return ad::normalize(Vec3<T>(across + d * distance));
}

template <class T, class P>
SurfacePoint<T> intersectCylinder(const CylinderView<P>& view, std::uint32_t root,
                                  const Vec3<T>& origin, const Vec3<T>& direction) {
  T distance, z;
  const Vec3<T> n = meetCylinder<T>(view, root, origin, direction, distance, z);
  return cylinderPoint<T>(view, n, z);
}

// Unit vectors across the axis: towards the point `around`, and a quarter turn on.
template <class P>
void azimuthsAround(const CylinderView<P>& view, const Vec3<Scalar<P>>& around, Vec3<P>& towards,
                    Vec3<P>& beside) {
  const Vec3<P> way = liftFrom<P>(around) - view.start;
  towards = ad::normalize(Vec3<P>(way - view.axis * dot(way, view.axis)));
  beside = cross(view.axis, towards);
}

// Azimuth from that of `around`, and share of the height.
template <class T, class P>
Vec2<T> cylinderCoordinates(const CylinderView<P>& view, std::uint32_t root,
                            const Vec3<Scalar<P>>& around, const Vec3<T>& origin,
                            const Vec3<T>& direction, T& distance) {
  T z;
  const Vec3<T> n = meetCylinder<T>(view, root, origin, direction, distance, z);
  Vec3<P> towards, beside;
  azimuthsAround(view, around, towards, beside);
  return {ad::atan2(T(dot(n, beside)), T(dot(n, towards))), z};
}

template <class T, class P>
SurfacePoint<T> cylinderPointAt(const CylinderView<P>& view, const Vec3<Scalar<P>>& around,
                                const Vec2<T>& at) {
  Vec3<P> towards, beside;
  azimuthsAround(view, around, towards, beside);
  T sine, cosine;
  ad::sincos(at.x, sine, cosine);
  Vec3<T> n;
  for (int i = 0; i < 3; ++i) n[i] = cosine * towards[i] + sine * beside[i];
  return cylinderPoint<T>(view, n, at.y);
}

template <class T, class P>
SurfacePoint<T> sampleCylinder(const CylinderView<P>& view, const T& u0, const T& u1) {
  T sine, cosine;
  ad::sincos(T(u1 * Scalar<T>(2 * std::numbers::pi)), sine, cosine);
  Vec3<T> n;
  for (int i = 0; i < 3; ++i) n[i] = cosine * view.x[i] + sine * view.y[i];
  return cylinderPoint<T>(view, n, u0);
}

}  // namespace h2mc::detail
