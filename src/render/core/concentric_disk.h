// SPDX-License-Identifier: MIT
// The square as a disk.
#pragma once

#include <numbers>

#include "render/core/types.h"

namespace h2mc {

// The point of the unit disk that (u0, u1) in [0, 1)^2 stand for: areas keep their ratios, the square's centre is the
// disk's, and neither is cut open as by polar coordinates. Smooth but on the square's diagonals.
// [Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square"]
template <class T>
Vec2<T> concentricDisk(const T& u0, const T& u1) {
  using S = Scalar<T>;
  constexpr S kQuarter = S(std::numbers::pi / 4);
  const T a = u0 * S(2) - S(1), b = u1 * S(2) - S(1);
  const bool first = std::abs(value(a)) > std::abs(value(b));
  const T& radius = first ? a : b;
  // In the very centre the angle has no derivative; what multiplies it is zero.
  if (value(radius) == 0) return {a * kQuarter, b * kQuarter};
  T s, c;
  ad::sincos(T((first ? b : a) / radius * kQuarter), s, c);
  return first ? Vec2<T>{radius * c, radius * s} : Vec2<T>{radius * s, radius * c};
}

}  // namespace h2mc
