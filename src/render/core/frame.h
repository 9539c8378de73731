// Orthonormal shading frames.
#pragma once

#include <cmath>

#include "render/core/types.h"

namespace h2mc {

// A right-handed orthonormal basis; n is the normal. In local coordinates z = cos(theta).
template <class T>
struct Frame {
  Vec3<T> s, t, n;

  Vec3<T> toLocal(const Vec3<T>& w) const { return {dot(w, s), dot(w, t), dot(w, n)}; }
  Vec3<T> toWorld(const Vec3<T>& w) const { return s * w.x + t * w.y + n * w.z; }

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
