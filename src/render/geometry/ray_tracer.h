// Visibility, by Embree. The only module that knows Embree.
//
// `time` is the moment in [0, 1] of the shutter's opening. Embree moves what moves in the same steps as
// the templated code (shape.h), so that both see the same surfaces.
#pragma once

#include <memory>
#include <span>

#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc {

class RayTracer {
 public:
  // Keeps references to the shapes: they must outlive the tracer and stay where they are.
  explicit RayTracer(std::span<const Shape> shapes);
  ~RayTracer();

  // The first primitive along the ray from `origin` (unit direction). For an origin on a surface
  // pass its geometric normal: the ray starts a few ulps off the surface, on the direction's side;
  // otherwise pass a zero vector. Invalid when nothing is hit. Thread-safe.
  PrimitiveId intersect(const Vec3f& origin, const Vec3f& normal, const Vec3f& direction,
                        float minDistance = 0, float maxDistance = kFar, float time = 0) const;

  // True when nothing lies between two points, both offset along their normals towards each other
  // (zero normal: no offset). Thread-safe.
  bool visible(const Vec3f& from, const Vec3f& fromNormal, const Vec3f& to, const Vec3f& toNormal,
               float time = 0) const;
  // True when a ray leaves the scene.
  bool escapes(const Vec3f& origin, const Vec3f& normal, const Vec3f& direction,
               float time = 0) const;

  static constexpr float kFar = 1e30f;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace h2mc
