// SPDX-License-Identifier: MIT
// A path as such, whatever the technique that made it: what path-space mutations move and MIS weights
// are a function of.
#pragma once

#include <array>

#include "render/path/path.h"

namespace h2mc {

struct FullVertex {
  // x_0 of an infinite light is not there, nor is the eye of a parallel camera; x_0 of a point or spot light and the
  // eye have only `p`, and a geometric normal of zero.
  SurfacePoint<float> point;
  // As a ray finds it, but that it says 0 of spheres, whose two roots depend on where the ray comes from
  // (see primitiveSeen). Invalid where there is no surface.
  PrimitiveId id;
  // Whether the path goes on through a delta lobe, and which, as seen from the camera's side. The choice
  // of a delta lobe is a part of the path, that of another one is not.
  bool delta = false;
  LobeId lobe;
};

// x_0 on the light, .., x_k the eye, k = edges >= 1 [Veach 1997, section 8.2, whose x_0 is on the light as well].
// Of fixed size: never allocates.
struct FullPath {
  int edges = 0;
  std::array<FullVertex, kMaxPathLength + 1> x;
  int light = -1;  // index into Scene::lights
  PrimitiveId
      lightPrimitive;     // as the light's choosePrimitive() says it; invalid without a surface
  bool infinite = false;  // the light is: the edge from x_1 goes along `escape`
  Vec3f escape{0};        // unit, towards an infinite light
  bool parallel = false;  // the camera is: the edge to x_(k-1) goes along `view`
  Vec3f view{0};          // unit, from a parallel camera
  float time = 0;         // this and the next as in PrimarySample
  std::array<float, 2> aperture{0.5f, 0.5f};
  float filmX = 0,
        filmY = 0;  // where the eye sees x_(k-1); for mutations, where it has looked last

  const FullVertex& eye() const { return x[at(edges)]; }
};

// The path without its technique; false where it carries nothing (target 0). Light points, which a Path
// has only as coordinates, are sampled again from these.
bool toFull(const Scene& scene, const Path& path, FullPath& full);

// A primitive that a ray has found as FullVertex::id says it.
PrimitiveId primitiveMet(const Scene& scene, PrimitiveId hit);
// The end x_0 on a light `full.light` that was sampled: with the choice `primitive` made, at (u0, u1) of its samples.
// For infinite lights the unit direction to it where the sample was of its emission, null where it was direct (from
// x_1).
void setLightPoint(const Scene& scene, FullPath& full, PrimitiveId primitive, float u0, float u1,
                   const Vec3f* direction);
// The end x_0 that was hit from x_1: at full.x[0] with a valid id, else along full.escape. False where nothing emits.
bool setLightHit(const Scene& scene, FullPath& full);

// Unit direction from x_i to x_(i-1), 1 <= i <= k; its length, infinity for an infinite light and a parallel camera.
Vec3f directionToLight(const FullPath& path, int i, float& distance);

// What a ray along `direction` (any length) that meets vertex `v` finds: `v.id`, for spheres with the root.
PrimitiveId primitiveSeen(const Scene& scene, const FullVertex& v, const Vec3f& direction);

// A delta lobe as it is called by who arrives from the local direction `wi`.
LobeId lobeSeenFrom(const Scene& scene, PrimitiveId id, LobeId lobe, float wiZ);

}  // namespace h2mc
