// A point on a surface, with everything that scattering and emission need there.
#pragma once

#include "render/core/frame.h"

namespace h2mc {

// Which primitive a path vertex lies on: part of a path's topology.
// `primitive` is the triangle of a mesh; for a sphere it is 0 for the nearer and 1 for the farther
// intersection along the ray; for a disk it is 0.
struct PrimitiveId {
  std::uint32_t shape = ~0u;
  std::uint32_t primitive = 0;
  bool valid() const { return shape != ~0u; }
  bool operator==(const PrimitiveId&) const = default;
};

template <class T>
struct SurfacePoint {
  Vec3<T> p;          // world space
  Vec3<T> ng;         // geometric normal, unit, on the shading normal's side
  Frame<T> shading;   // shading frame, from the interpolated normal where the mesh has one
  bool flat = false;  // shading.n is ng
  bool constantNormal = false;  // ng has no derivatives
  Vec2<T> uv;                   // texture coordinates (barycentric ones where the mesh has none)

  // Of ng and w.
  T cosine(const Vec3<T>& w) const {
    if constexpr (ad::isDual<T>)
      if (constantNormal) return dot(w, value3(ng));
    return dot(ng, w);
  }
};

}  // namespace h2mc
