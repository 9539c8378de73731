// SPDX-License-Identifier: MIT
// Directions from primary coordinates: what the sampling routines of BSDFs and lights share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/core/types.h"
#include "render/core/unit_interval.h"

namespace h2mc {

template <class T>
inline constexpr Scalar<T> kInvPiOf = std::numbers::inv_pi_v<Scalar<T>>;

// The smallest u0 that sampling distinguishes from 0. Every lobe draws sin(theta) ~ sqrt(u0), which
// has no derivative at 0; below this bound (a random number never is, but for 0 itself) u0 counts
// as a constant and the derivatives stay finite.
inline constexpr float kSmallestCoordinate = 1e-12f;

template <class T>
T awayFromPole(const T& u0) {
  return ad::max(u0, Scalar<T>(kSmallestCoordinate));
}

// (sinTheta cos(phi), sinTheta sin(phi), cosTheta) with phi = 2 pi u1.
template <class T>
Vec3<T> fromPolar(const T& sinTheta, const T& cosTheta, const T& u1) {
  T sinPhi, cosPhi;
  ad::sincos(T(u1 * (2 * std::numbers::pi_v<Scalar<T>>)), sinPhi, cosPhi);
  return {sinTheta * cosPhi, sinTheta * sinPhi, cosTheta};
}

// Density cos(theta) / pi; u0 = sin^2(theta).
template <class T>
Vec3<T> sampleCosine(const T& u0, const T& u1) {
  // The cosine is constant where the sine is: the direction is to stay a unit vector.
  const T u = awayFromPole(u0);
  return fromPolar<T>(ad::sqrt(u), ad::sqrt(T(Scalar<T>(1) - u)), u1);
}

// The u1 with phi = 2 pi u1.
inline float invertAzimuth(double x, double y) {
  const double u = std::atan2(y, x) * (0.5 * std::numbers::inv_pi);
  const float wrapped = static_cast<float>(u < 0 ? u + 1 : u);
  return wrapped < 1 ? wrapped : 0;
}

inline bool invertCosine(const Vec3f& wo, Vec2f& u) {
  if (!(wo.z > 0)) return false;
  const double x = wo.x, y = wo.y, z = wo.z;
  const double sin2 = x * x + y * y;
  u = {toUnitInterval(sin2 / (sin2 + z * z)), invertAzimuth(x, y)};
  return true;
}

// What a lobe returns when (u0, u1) draw nothing (a facet seen from behind, a reflection below the
// surface): a unit vector in the surface, for which every evaluate() is zero.
template <class T>
Vec3<T> noDirection() {
  return {T(1), T(0), T(0)};
}

template <class T>
Vec3<T> mirrored(const Vec3<T>& w) {
  return {-w.x, -w.y, w.z};
}

// The same direction seen from the other side.
template <class T>
Vec3<T> flipped(const Vec3<T>& w) {
  return {w.x, w.y, -w.z};
}

}  // namespace h2mc
