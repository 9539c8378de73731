// SPDX-License-Identifier: MIT
#pragma once

#include "render/core/types.h"

namespace h2mc {

// The same colour everywhere.
struct ConstantTexture {
  Rgbf color{0};

  template <class T>
  Rgb<T> evaluate(const Vec2<T>&) const {
    const Vec3<Scalar<T>> c = plain<T>(color);
    return {T(c.x), T(c.y), T(c.z)};
  }
  Rgbf average() const { return color; }
  Rgbf maximum() const { return color; }
};

}  // namespace h2mc
