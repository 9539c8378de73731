// SPDX-License-Identifier: MIT
// Orthonormal shading frames.
#pragma once

#include <cmath>

#include "render/core/safe_math.h"

namespace h2mc {

// A right-handed orthonormal basis; n is the normal. In local coordinates z = cos(theta).
template <class T>
struct Frame {
  Vec3<T> s, t, n;
  bool constant = false;  // has no derivatives: only the values are of use

  Vec3<T> toLocal(const Vec3<T>& w) const {
    if constexpr (ad::isDual<T>)
      if (constant) return {dot(w, value3(s)), dot(w, value3(t)), dot(w, value3(n))};
    return {dot(w, s), dot(w, t), dot(w, n)};
  }
  Vec3<T> toWorld(const Vec3<T>& w) const {
    if constexpr (ad::isDual<T>) {
      const auto component = [&](const T& x, const T& y, const T& z) {
        if (constant) return linear3(w.x, value(x), w.y, value(y), w.z, value(z));
        return dot3(w.x, x, w.y, y, w.z, z);
      };
      return {component(s.x, t.x, n.x), component(s.y, t.y, n.y), component(s.z, t.z, n.z)};
    } else {
      return s * w.x + t * w.y + n * w.z;
    }
  }

  // Takes over a frame of T, or a plain one: its values alone, derivatives are not even set.
  template <class P>
  void assign(const Frame<P>& a) {
    if constexpr (std::is_same_v<P, T>) {
      *this = a;
    } else {
      constant = true;
      setValue(s, a.s);
      setValue(t, a.t);
      setValue(n, a.n);
    }
  }

  // Precondition: n is of unit length. Branches on the sign of n.z only, which freezes the
  // tangents' choice at a topology [Duff et al. 2017, "Building an Orthonormal Basis, Revisited"].
  static Frame fromNormal(const Vec3<T>& n) {
    using S = Scalar<T>;
    const S sign = std::copysign(S(1), value(n.z));
    const T a = S(-1) / (n.z + sign);
    const T b = n.x * n.y * a;
    return {
        {n.x * n.x * a * sign + S(1), b * sign, n.x * -sign}, {b, n.y * n.y * a + sign, -n.y}, n};
  }
};

}  // namespace h2mc
