// SPDX-License-Identifier: MIT
// How far off their surfaces rays start, so that they do not meet again what they leave.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc {

class RayOffset {
 public:
  // Looks at the shapes once and keeps nothing of them.
  explicit RayOffset(std::span<const Shape> shapes);

  // The end, moved off its surface to the side that `direction` points to; by an offset that depends on where it
  // lies and on what: [Waechter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection"] without
  // absolute lengths. An end on an unknown shape is moved as far as the worst of them asks for.
  Vec3f leave(const RayEnd& end, const Vec3f& direction) const {
    const float slack = slack_[std::min<std::size_t>(end.shape, slack_.size() - 1)];
    const float distance =
        std::max({std::abs(end.p.x), std::abs(end.p.y), std::abs(end.p.z)}) * kRelative + slack;
    return end.p + end.normal * (dot(end.normal, direction) < 0 ? -distance : distance);
  }

  // Whether the point `other` lies in the surface's plane at `end`, as far as rounding can tell: an edge between two
  // points of one plane carries no light, but has cosines of some ulps.
  static bool inPlane(const RayEnd& end, const Vec3f& other) {
    const float coordinates = std::max({std::abs(end.p.x), std::abs(end.p.y), std::abs(end.p.z),
                                        std::abs(other.x), std::abs(other.y), std::abs(other.z)});
    return end.normal != Vec3f(0) &&
           std::abs(dot(end.normal, other - end.p)) <= kFlat * coordinates;
  }

  // The mesh's triangles, in ascending order, that are too large for float beside the scene's other shapes: rays
  // have to meet these in double (exact_hit.h). leave() takes it for granted.
  std::span<const std::uint32_t> vast(std::size_t shape) const { return vast_[shape]; }

 private:
  // The offset relative to the largest coordinate of the end: 16 units in the last place, when a point on a surface is
  // off by half of one.
  static constexpr float kRelative = 0x1p-20f;
  // Rounding of two points and a normal, relative to the largest coordinate.
  static constexpr float kFlat = 0x1p-21f;

  std::vector<float>
      slack_;  // of each shape, and last the largest: what does not depend on the end's place
  std::vector<std::vector<std::uint32_t>> vast_;
};

}  // namespace h2mc
