// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "render/core/types.h"

namespace h2mc {

// A point of a mesh as two numbers that can stand for its texture coordinates: which triangle it is on, and where.
// Triangles have cells of 2 x 2, `columns` to a row, and their barycentric coordinates are in the middle of these, so
// that rounding leads to no other triangle.
struct MeshPlace {
  template <class T>
  static Vec2<T> of(std::uint32_t triangle, std::uint32_t columns, const T& b1, const T& b2) {
    using S = Scalar<T>;
    return {b1 + origin<S>(triangle % columns), b2 + origin<S>(triangle / columns)};
  }
  static std::uint32_t columnsFor(std::size_t triangles) {
    return static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(triangles))));
  }

  // The inverse; outside all cells the first one's.
  template <class S>
  MeshPlace(const Vec2<S>& place, std::uint32_t columns, std::size_t triangles) {
    const S end = S(2) * S(columns);
    if (!(place.x >= 0 && place.x < end && place.y >= 0 && place.y < end)) return;
    const auto x = static_cast<std::uint32_t>(place.x) / 2;
    const auto y = static_cast<std::uint32_t>(place.y) / 2;
    if (std::size_t{y} * columns + x >= triangles) return;
    column = x;
    row = y;
    triangle = y * columns + x;
  }
  template <class T>
  T b1(const Vec2<T>& place) const {
    return place.x - origin<Scalar<T>>(column);
  }
  template <class T>
  T b2(const Vec2<T>& place) const {
    return place.y - origin<Scalar<T>>(row);
  }

  std::uint32_t triangle = 0, column = 0, row = 0;

 private:
  template <class S>
  static S origin(std::uint32_t cell) {
    return S(2) * S(cell) + S(0.5);
  }
};

}  // namespace h2mc
