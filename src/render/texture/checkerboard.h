// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "render/texture/mapping.h"

namespace h2mc {

// Two colours by turns, 2 x 2 fields to the unit square.
struct CheckerboardTexture {
  Rgbf color0{0.4f}, color1{0.2f};
  TextureMapping mapping;

  template <class T>
  Rgb<T> evaluate(const Vec2<T>& uv) const {
    using S = Scalar<T>;
    const Vec2<S> p = mapping(value2(uv));
    const Vec3<S> c = plain<T>(field(p.x) == field(p.y) ? color0 : color1);
    return {T(c.x), T(c.y), T(c.z)};
  }
  Rgbf average() const { return (color0 + color1) * 0.5f; }
  Rgbf maximum() const { return glm::max(color0, color1); }

 private:
  // Parity of the field. Fields are counted towards zero, as Mitsuba 0.6 does: the one at u = 0 is
  // twice as wide and reaches from -1/2 to 1/2.
  template <class S>
  static bool field(S x) {
    return std::fmod(std::trunc(x * 2), S(2)) != 0;
  }
};

}  // namespace h2mc
