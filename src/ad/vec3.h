// SPDX-License-Identifier: MIT
// Vectors of plain numbers and of duals: GLM's type, with the fused operations of Dual2 behind
// GLM's names. The overloads here are more specialised than GLM's, so both may be visible.
//
// "Mixed" operations take one plain vector (or number) and one of duals, which costs much less
// than converting the plain one.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ad/dual.h"
#include "ad/functions.h"
#include "ad/traits.h"

namespace h2mc::ad {

template <class T>
using Vec2 = glm::vec<2, T, glm::defaultp>;
template <class T>
using Vec3 = glm::vec<3, T, glm::defaultp>;

/// The vector of values.
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<T> value(const Vec3<Dual<T, N, O>>& a) {
  return Vec3<T>(a.x.v, a.y.v, a.z.v);
}
template <std::floating_point T>
H2MC_AD_INLINE Vec3<T> value(const Vec3<T>& a) {
  return a;
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec2<T> value(const Vec2<Dual<T, N, O>>& a) {
  return Vec2<T>(a.x.v, a.y.v);
}
template <std::floating_point T>
H2MC_AD_INLINE Vec2<T> value(const Vec2<T>& a) {
  return a;
}
template <Real T>
H2MC_AD_INLINE bool isFinite(const Vec3<T>& a) {
  return isFinite(a.x) && isFinite(a.y) && isFinite(a.z);
}

// ---------------------------------------------------------------------------------- arithmetic

#define H2MC_AD_COMPONENTWISE(op)                                                                  \
  template <class T, int N, int O>                                                                 \
  H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator op(const Vec3<Dual<T, N, O>>& a,                     \
                                                 const Vec3<Dual<T, N, O>>& b) {                   \
    return Vec3<Dual<T, N, O>>(a.x op b.x, a.y op b.y, a.z op b.z);                                \
  }                                                                                                \
  template <class T, int N, int O>                                                                 \
  H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator op(const Vec3<Dual<T, N, O>>& a, const Vec3<T>& b) { \
    return Vec3<Dual<T, N, O>>(a.x op b.x, a.y op b.y, a.z op b.z);                                \
  }                                                                                                \
  template <class T, int N, int O>                                                                 \
  H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator op(const Vec3<T>& a, const Vec3<Dual<T, N, O>>& b) { \
    return Vec3<Dual<T, N, O>>(a.x op b.x, a.y op b.y, a.z op b.z);                                \
  }
H2MC_AD_COMPONENTWISE(+)
H2MC_AD_COMPONENTWISE(-)
H2MC_AD_COMPONENTWISE(*)
#undef H2MC_AD_COMPONENTWISE

template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator-(const Vec3<Dual<T, N, O>>& a) {
  return Vec3<Dual<T, N, O>>(-a.x, -a.y, -a.z);
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(const Vec3<Dual<T, N, O>>& a, const Dual<T, N, O>& s) {
  return Vec3<Dual<T, N, O>>(a.x * s, a.y * s, a.z * s);
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(const Dual<T, N, O>& s, const Vec3<Dual<T, N, O>>& a) {
  return a * s;
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(const Vec3<T>& a, const Dual<T, N, O>& s) {
  return Vec3<Dual<T, N, O>>(s * a.x, s * a.y, s * a.z);
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(const Dual<T, N, O>& s, const Vec3<T>& a) {
  return a * s;
}
template <class T, int N, int O, Arithmetic S>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(const Vec3<Dual<T, N, O>>& a, S s) {
  return Vec3<Dual<T, N, O>>(a.x * s, a.y * s, a.z * s);
}
template <class T, int N, int O, Arithmetic S>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator*(S s, const Vec3<Dual<T, N, O>>& a) {
  return a * s;
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator/(const Vec3<Dual<T, N, O>>& a, const Dual<T, N, O>& s) {
  return a * (T(1) / s);
}
template <class T, int N, int O, Arithmetic S>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> operator/(const Vec3<Dual<T, N, O>>& a, S s) {
  return Vec3<Dual<T, N, O>>(a.x / s, a.y / s, a.z / s);
}
// ------------------------------------------------------------------------------------ products

template <Real T>
H2MC_AD_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return dot3(a.x, b.x, a.y, b.y, a.z, b.z);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> dot(const Vec3<Dual<T, N, O>>& a, const Vec3<T>& b) {
  return linear3(a.x, b.x, a.y, b.y, a.z, b.z);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> dot(const Vec3<T>& a, const Vec3<Dual<T, N, O>>& b) {
  return dot(b, a);
}
template <Real T>
H2MC_AD_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return Vec3<T>(differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
                 differenceOfProducts(a.x, b.y, a.y, b.x));
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> cross(const Vec3<Dual<T, N, O>>& a, const Vec3<T>& b) {
  return Vec3<Dual<T, N, O>>(linear2(a.y, b.z, a.z, -b.y), linear2(a.z, b.x, a.x, -b.z),
                             linear2(a.x, b.y, a.y, -b.x));
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> cross(const Vec3<T>& a, const Vec3<Dual<T, N, O>>& b) {
  return Vec3<Dual<T, N, O>>(linear2(b.z, a.y, b.y, -a.z), linear2(b.x, a.z, b.z, -a.x),
                             linear2(b.y, a.x, b.x, -a.y));
}

// ------------------------------------------------------------------------------------- lengths

/// The squared length.
template <Real T>
H2MC_AD_INLINE T length2(const Vec3<T>& a) {
  return sumOfSquares3(a.x, a.y, a.z);
}
template <Real T>
H2MC_AD_INLINE T length2(const Vec2<T>& a) {
  return dot2(a.x, a.x, a.y, a.y);
}
/// The length; no finite derivative at the null vector.
template <Real T>
H2MC_AD_INLINE T length(const Vec3<T>& a) {
  return sqrt(length2(a));
}
/// a at length 1; not finite for the null vector, nor where the squared length underflows.
template <Real T>
H2MC_AD_INLINE Vec3<T> normalize(const Vec3<T>& a) {
  return a * rsqrt(length2(a));
}
/// The squared distance.
template <Real T>
H2MC_AD_INLINE T distance2(const Vec3<T>& a, const Vec3<T>& b) {
  return length2(a - b);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> distance2(const Vec3<Dual<T, N, O>>& a, const Vec3<T>& b) {
  return length2(a - b);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> distance2(const Vec3<T>& a, const Vec3<Dual<T, N, O>>& b) {
  return length2(a - b);
}

/// u a + v b + w c for plain vectors a, b, c: a point of a triangle, a direction in a frame.
template <std::floating_point T>
H2MC_AD_INLINE Vec3<T> combine(T u, const Vec3<T>& a, T v, const Vec3<T>& b, T w,
                               const Vec3<T>& c) {
  return u * a + v * b + w * c;
}
template <class T, int N, int O>
H2MC_AD_INLINE Vec3<Dual<T, N, O>> combine(const Dual<T, N, O>& u, const Vec3<T>& a,
                                           const Dual<T, N, O>& v, const Vec3<T>& b,
                                           const Dual<T, N, O>& w, const Vec3<T>& c) {
  return Vec3<Dual<T, N, O>>(linear3(u, a.x, v, b.x, w, c.x), linear3(u, a.y, v, b.y, w, c.y),
                             linear3(u, a.z, v, b.z, w, c.z));
}

}  // namespace h2mc::ad
