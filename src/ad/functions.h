// SPDX-License-Identifier: MIT
// Elementary functions of plain numbers and of duals, by the same names.
//
// Values are those of the standard library, everywhere. Where a function has no finite derivative
// (sqrt, log and fractional powers at 0, asin and acos at +-1, atan2 and hypot at the origin, or a
// derivative that overflows), the derivatives of the result are infinite or NaN in the coordinates
// its argument depends on, and zero in the others: a constant stays a constant at every point.
// Ask isFinite.
//
// Templated code calls them as ad::f(x): argument-dependent lookup finds them for duals only, and
// a bare sqrt(float) may be the C library's for double.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "ad/dual.h"
#include "ad/traits.h"

namespace h2mc::ad {

// ------------------------------------------------------------------------------ plain numbers

template <std::floating_point T>
H2MC_AD_INLINE T sqrt(T x) {
  return std::sqrt(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T rsqrt(T x) {
  return T(1) / std::sqrt(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T exp(T x) {
  return std::exp(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T expm1(T x) {
  return std::expm1(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T log(T x) {
  return std::log(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T log1p(T x) {
  return std::log1p(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T sin(T x) {
  return std::sin(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T cos(T x) {
  return std::cos(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T tan(T x) {
  return std::tan(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T asin(T x) {
  return std::asin(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T acos(T x) {
  return std::acos(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T atan(T x) {
  return std::atan(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T atan2(T y, T x) {
  return std::atan2(y, x);
}
template <std::floating_point T>
H2MC_AD_INLINE T erf(T x) {
  return std::erf(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T abs(T x) {
  return std::abs(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T square(T x) {
  return x * x;
}
template <std::floating_point T>
H2MC_AD_INLINE T hypot(T x, T y) {
  return std::hypot(x, y);
}
template <std::floating_point T, Arithmetic S>
H2MC_AD_INLINE T pow(T x, S p) {
  return std::pow(x, static_cast<T>(p));
}
template <std::floating_point T>
H2MC_AD_INLINE void sincos(T x, T& s, T& c) {
  s = std::sin(x);
  c = std::cos(x);
}
template <std::floating_point T>
H2MC_AD_INLINE T dot2(T a, T x, T b, T y) {
  return a * x + b * y;
}
template <std::floating_point T>
H2MC_AD_INLINE T differenceOfProducts(T a, T x, T b, T y) {
  return a * x - b * y;
}
template <std::floating_point T>
H2MC_AD_INLINE T dot3(T a, T x, T b, T y, T d, T z) {
  return a * x + b * y + d * z;
}
template <std::floating_point T>
H2MC_AD_INLINE T sumOfSquares3(T a, T b, T d) {
  return a * a + b * b + d * d;
}
template <std::floating_point T>
H2MC_AD_INLINE T linear2(T a, T s, T b, T t) {
  return a * s + b * t;
}
template <std::floating_point T>
H2MC_AD_INLINE T linear3(T a, T s, T b, T t, T d, T u) {
  return a * s + b * t + d * u;
}
template <std::floating_point T>
H2MC_AD_INLINE bool isFinite(T x) {
  return x - x == T(0);
}

// -------------------------------------------------------------------------------------- duals

template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> sqrt(const Dual<T, N, O>& a) {
  const T f = std::sqrt(a.v), f1 = T(0.5) / f;
  return chain(a, f, f1, T(-0.5) * f1 / a.v);
}
/// 1 / sqrt(a)
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> rsqrt(const Dual<T, N, O>& a) {
  const T f = T(1) / std::sqrt(a.v), i = T(1) / a.v, f1 = T(-0.5) * f * i;
  return chain(a, f, f1, T(-1.5) * f1 * i);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> exp(const Dual<T, N, O>& a) {
  const T f = std::exp(a.v);
  return chainSmooth(a, f, f, f);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> expm1(const Dual<T, N, O>& a) {
  const T f = std::expm1(a.v);
  return chainSmooth(a, f, f + T(1), f + T(1));
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> log(const Dual<T, N, O>& a) {
  // Below the normal numbers 1 / a overflows, but that of a multiple doesn't.
  if (a.v < std::numeric_limits<T>::min()) [[unlikely]] {
    constexpr T kMultiple = T(1) / std::numeric_limits<T>::epsilon();
    const Dual<T, N, O> b = a * kMultiple;
    return chainLog(b, std::log(b.v) - std::log(kMultiple), T(1) / b.v);
  }
  return chainLog(a, std::log(a.v), T(1) / a.v);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> log1p(const Dual<T, N, O>& a) {
  return chainLog(a, std::log1p(a.v), T(1) / (T(1) + a.v));
}
template <class T, int N, int O>
H2MC_AD_INLINE void sincos(const Dual<T, N, O>& a, Dual<T, N, O>& s, Dual<T, N, O>& c) {
  const Dual<T, N, O> x = a;  // s or c may be a
  const T sine = std::sin(x.v), cosine = std::cos(x.v);
  s = chainSmooth(x, sine, cosine, -sine);
  c = chainSmooth(x, cosine, -sine, -cosine);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> sin(const Dual<T, N, O>& a) {
  const T f = std::sin(a.v);
  return chainSmooth(a, f, std::cos(a.v), -f);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> cos(const Dual<T, N, O>& a) {
  const T f = std::cos(a.v);
  return chainSmooth(a, f, -std::sin(a.v), -f);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> tan(const Dual<T, N, O>& a) {
  const T f = std::tan(a.v), f1 = T(1) + f * f;
  return chain(a, f, f1, T(2) * f * f1);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> asin(const Dual<T, N, O>& a) {
  const T d = (T(1) - a.v) * (T(1) + a.v), f1 = T(1) / std::sqrt(d);
  return chain(a, std::asin(a.v), f1, a.v * f1 / d);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> acos(const Dual<T, N, O>& a) {
  const T d = (T(1) - a.v) * (T(1) + a.v), f1 = T(-1) / std::sqrt(d);
  return chain(a, std::acos(a.v), f1, a.v * f1 / d);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> atan(const Dual<T, N, O>& a) {
  const T f1 = T(1) / (T(1) + a.v * a.v);
  return chain(a, std::atan(a.v), f1, T(-2) * a.v * f1 * f1);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> erf(const Dual<T, N, O>& a) {
  const T f1 = T(2) * std::numbers::inv_sqrtpi_v<T> * std::exp(-a.v * a.v);
  return chain(a, std::erf(a.v), f1, T(-2) * a.v * f1);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> square(const Dual<T, N, O>& a) {
  return chainSmooth(a, a.v * a.v, T(2) * a.v, T(2));
}
/// |a|, with the derivatives of a at 0.
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> abs(const Dual<T, N, O>& a) {
  return a * (a.v < T(0) ? T(-1) : T(1));
}
/// The angle of (x, y) from the x axis, in [-pi, pi].
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> atan2(const Dual<T, N, O>& y, const Dual<T, N, O>& x) {
  // On the vector scaled to a largest coordinate of 1, so that no square under- or overflows.
  const T scale = T(1) / std::fmax(std::abs(x.v), std::abs(y.v));
  const T xs = x.v * scale, ys = y.v * scale, i = scale / (xs * xs + ys * ys);
  const T fy = xs * i, fx = -ys * i, fxx = T(-2) * fy * fx;
  return chain(y, x, std::atan2(y.v, x.v), fy, fx, -fxx, (ys * i) * (ys * i) - fy * fy, fxx);
}
/// sqrt(x^2 + y^2) without under- or overflow.
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> hypot(const Dual<T, N, O>& x, const Dual<T, N, O>& y) {
  const T f = std::hypot(x.v, y.v), i = T(1) / f, fx = x.v * i, fy = y.v * i;
  return chain(x, y, f, fx, fy, fy * fy * i, -fx * fy * i, fx * fx * i);
}
/// a^p. At a = 0 the derivatives are the limits from the right.
template <class T, int N, int O, Arithmetic S>
H2MC_AD_INLINE Dual<T, N, O> pow(const Dual<T, N, O>& a, S exponent) {
  const T p = static_cast<T>(exponent), f = std::pow(a.v, p);
  if (a.v != T(0) && std::abs(f) >= std::numeric_limits<T>::min()) [[likely]] {
    const T i = T(1) / a.v, f1 = p * f * i;
    return chain(a, f, f1, (p - T(1)) * f1 * i);
  }
  const T f1 = p == T(0) ? T(0) : p * std::pow(a.v, p - T(1));
  const T f2 = p == T(0) || p == T(1) ? T(0) : p * (p - T(1)) * std::pow(a.v, p - T(2));
  return chain(a, f, f1, f2);
}
template <Arithmetic S, class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> pow(S base, const Dual<T, N, O>& p) {
  const T f = std::pow(static_cast<T>(base), p.v), l = std::log(static_cast<T>(base));
  const T f1 = f == T(0) ? T(0) : f * l;
  return chain(p, f, f1, f1 == T(0) ? T(0) : f1 * l);
}
template <class T, int N, int O>
H2MC_AD_INLINE Dual<T, N, O> pow(const Dual<T, N, O>& a, const Dual<T, N, O>& p) {
  const T f = std::pow(a.v, p.v), f1 = std::pow(a.v, p.v - T(1)), l = std::log(a.v);
  const T fa = p.v == T(0) ? T(0) : p.v * f1;
  const T faa = p.v == T(0) || p.v == T(1) ? T(0)
                : fa != T(0)               ? fa * (p.v - T(1)) / a.v
                                           : p.v * (p.v - T(1)) * std::pow(a.v, p.v - T(2));
  const T fp = f == T(0) ? T(0) : f * l;
  const T fap = f1 == T(0) ? T(0) : f1 * (T(1) + p.v * l);
  return chain(a, p, f, fa, fp, faa, fap, fp == T(0) ? T(0) : fp * l);
}

// --------------------------------------------------------------------------- choice by value

template <class T>
concept Real = std::floating_point<T> || AnyDual<T>;

template <Real T>
H2MC_AD_INLINE T select(bool condition, const T& a, const T& b) {
  return condition ? a : b;
}
/// The operand with the smaller value, a where they are equal.
template <Real T>
H2MC_AD_INLINE T min(const T& a, const T& b) {
  return b < a ? b : a;
}
template <AnyDual T, Arithmetic S>
H2MC_AD_INLINE T min(const T& a, S b) {
  return b < a ? T(b) : a;
}
template <AnyDual T, Arithmetic S>
H2MC_AD_INLINE T min(S a, const T& b) {
  return b < a ? b : T(a);
}
/// The operand with the larger value, a where they are equal.
template <Real T>
H2MC_AD_INLINE T max(const T& a, const T& b) {
  return a < b ? b : a;
}
template <AnyDual T, Arithmetic S>
H2MC_AD_INLINE T max(const T& a, S b) {
  return a < b ? T(b) : a;
}
template <AnyDual T, Arithmetic S>
H2MC_AD_INLINE T max(S a, const T& b) {
  return a < b ? b : T(a);
}
/// x held to [low, high]; at and inside the bounds it keeps its derivatives, outside they are 0.
template <Real T>
H2MC_AD_INLINE T clamp(const T& x, Scalar<T> low, Scalar<T> high) {
  return x < low ? T(low) : high < x ? T(high) : x;
}

}  // namespace h2mc::ad
