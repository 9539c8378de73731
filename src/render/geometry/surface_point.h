// SPDX-License-Identifier: MIT
// A point on a surface, with everything that scattering and emission need there.
#pragma once

#include "render/core/frame.h"

namespace h2mc {

// Which primitive a path vertex lies on: part of a path's topology.
// `primitive` is the triangle of a mesh; for a sphere or cylinder it is 0 for the nearer and 1 for the farther
// intersection along the ray; for a disk it is 0.
struct PrimitiveId {
  std::uint32_t shape = ~0u;
  std::uint32_t primitive = 0;
  bool valid() const { return shape != ~0u; }
  bool operator==(const PrimitiveId&) const = default;
};

// Where a ray starts or ends, and what is to be left behind there.
struct RayEnd {
  Vec3f p{0};
  Vec3f normal{0};            // geometric, unit; zero where there is no surface
  std::uint32_t shape = ~0u;  // on which it lies; ~0: unknown, or none
};

// What a frame map has done to a shading frame, and when nothing is scattered for it: where light and its
// frame disagree on the side it arrives at (light), or both directions and it (both), by the shading normal.
enum class Bend : std::uint8_t { kNone, kLight, kBoth };

template <class T>
struct SurfacePoint {
  Vec3<T> p;          // world space
  Vec3<T> ng;         // geometric normal, unit, on the shading normal's side
  Frame<T> shading;   // shading frame, from the interpolated normal where the mesh has one
  bool flat = false;  // shading.n is ng
  bool constantNormal = false;  // ng has no derivatives
  Bend bend = Bend::kNone;      // of shading; unless it is none:
  Vec3<Scalar<T>> unbent;       // the shading normal before
  Vec2<T> uv;  // texture coordinates (barycentric ones where the mesh has none); or a MeshPlace
  std::uint32_t shape = ~0u;  // the PrimitiveId's

  // Of ng and w.
  T cosine(const Vec3<T>& w) const {
    if constexpr (ad::isDual<T>)
      if (constantNormal) return dot(w, value3(ng));
    return dot(ng, w);
  }
  // Whether nothing is scattered from light in the direction toLight to toCamera (world space) because a
  // frame map disagrees with the shading normal about a side.
  bool bendBlocks(const Vec3<T>& toLight, const Vec3<T>& toCamera) const {
    if (bend == Bend::kNone) [[likely]]
      return false;
    const auto agrees = [&](const Vec3<T>& w) {
      const Vec3<Scalar<T>> direction = value3(w);
      return dot(direction, unbent) * dot(direction, value3(shading.n)) > 0;
    };
    return !agrees(toLight) || (bend == Bend::kBoth && !agrees(toCamera));
  }
  RayEnd end() const requires std::is_same_v<T, float> { return {p, ng, shape}; }
};

}  // namespace h2mc
