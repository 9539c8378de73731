// SPDX-License-Identifier: MIT
// Functions whose derivatives stay finite at the border of their domain, and helpers for vectors of
// duals.
#pragma once

#include <cmath>

#include "render/core/types.h"

namespace h2mc {

// The fused operations: for duals they are found through their arguments, for plain numbers here.
using ad::dot2;
using ad::linear2;
using ad::linear3;

// sqrt(x); 0 for negative x. Passive below 1e-12, where the second derivative would be near
// overflow: such a coordinate is treated as if it did not move.
template <class T>
T safeSqrt(const T& x) {
  using S = Scalar<T>;
  const S v = value(x);
  if (v > S(1e-12)) return ad::sqrt(x);
  return T(v > 0 ? std::sqrt(v) : S(0));
}

// The angle of (x, y) in [0, 1) turns; passive at the origin.
template <class T>
T turns(const T& y, const T& x) {
  using S = Scalar<T>;
  const S vx = value(x), vy = value(y);
  if (vx * vx + vy * vy < S(1e-14)) return T(S(0));
  const T t = ad::atan2(y, x) * S(0.5 / std::numbers::pi);
  // A tiny negative angle rounds to a whole turn.
  return value(t) >= 0 ? t : value(t) + S(1) < S(1) ? T(t + S(1)) : T(S(0));
}

// A plain vector as one of T.
template <class T>
Vec3<T> lift(const Vec3<Scalar<T>>& a) {
  return {T(a.x), T(a.y), T(a.z)};
}

// The same for a vector that may be of T already.
template <class T, class P>
Vec3<T> liftFrom(const Vec3<P>& a) {
  if constexpr (std::is_same_v<P, T>)
    return a;
  else
    return lift<T>(a);
}

// a s + b t for duals a, b and weights that are plain numbers or duals.
template <class T, class P>
T weighted2(const T& a, const P& s, const T& b, const P& t) {
  if constexpr (ad::isDual<P>)
    return dot2(a, s, b, t);
  else
    return linear2(a, s, b, t);
}

// Gives a, which keeps its derivatives, another value: a more exact one. V: a vector.
template <class V, class W>
void setValue(V& a, const W& v) {
  for (int i = 0; i < V::length(); ++i) {
    if constexpr (ad::isDual<typename V::value_type>)
      a[i].v = v[i];
    else
      a[i] = v[i];
  }
}
template <class V, class W>
V withValue(V a, const W& v) {
  setValue(a, v);
  return a;
}

}  // namespace h2mc
