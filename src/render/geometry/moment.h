// SPDX-License-Identifier: MIT
// Where in a motion's steps a moment lies.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/core/types.h"

namespace h2mc {

// A moment between steps `index` and `index + 1`, `fraction` of the way. Which two steps is decided
// by value: it is frozen with a path's topology.
template <class T>
struct Moment {
  int index;
  T fraction;

  // `time` in [0, 1]: share of the shutter's opening. The arithmetic is Embree's, so that both choose
  // the same segment.
  static Moment at(int segments, const T& time) {
    using S = Scalar<T>;
    const T scaled = time * S(segments);
    const int index = std::clamp(static_cast<int>(std::floor(value(scaled))), 0, segments - 1);
    return {index, scaled - S(index)};
  }

  // The straight line from a to b.
  T between(Scalar<T> a, Scalar<T> b) const { return fraction * (b - a) + a; }
  Vec3<T> between(const Vec3f& a, const Vec3f& b) const {
    using S = Scalar<T>;
    return {between(S(a.x), S(b.x)), between(S(a.y), S(b.y)), between(S(a.z), S(b.z))};
  }
  // The same in double, values only.
  glm::dvec3 exactlyBetween(const Vec3f& a, const Vec3f& b) const {
    const glm::dvec3 from(a);
    return from + (glm::dvec3(b) - from) * static_cast<double>(value(fraction));
  }
};

}  // namespace h2mc
