// SPDX-License-Identifier: MIT
// Two coordinates for the unit vectors near one.
#pragma once

#include "render/core/frame.h"

namespace h2mc {

// Lengths along two tangents at `axis`, which has the coordinates (0, 0). Good for the hemisphere
// around it.
template <class S>
struct DirectionChart {
  Frame<S> frame;

  // Precondition: `axis` is of unit length.
  explicit DirectionChart(const Vec3<S>& axis) : frame(Frame<S>::fromNormal(axis)) {}

  template <class T>
  Vec3<T> direction(const Vec2<T>& at) const {
    const T along = sqrt(S(1) - dot2(at.x, at.x, at.y, at.y));
    const auto component = [&](int i) -> T {
      return linear3(at.x, frame.s[i], at.y, frame.t[i], along, frame.n[i]);
    };
    return {component(0), component(1), component(2)};
  }
  template <class T>
  Vec2<T> coordinates(const Vec3<T>& direction) const {
    return {dot(direction, frame.s), dot(direction, frame.t)};
  }
};

}  // namespace h2mc
