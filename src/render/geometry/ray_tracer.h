// SPDX-License-Identifier: MIT
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

  // The first primitive along the ray in unit direction `direction`. From a surface it starts a few ulps off it,
  // on the direction's side (ray_offset.h). Invalid when nothing is hit. Thread-safe, as the others.
  PrimitiveId intersect(const RayEnd& from, const Vec3f& direction, float minDistance = 0,
                        float maxDistance = kFar, float time = 0) const;

  // True when nothing lies between the two, both moved off their surfaces towards each other. False when one lies in
  // the plane of the other's surface.
  bool visible(const RayEnd& from, const RayEnd& to, float time = 0) const;
  // True when a ray leaves the scene.
  bool escapes(const RayEnd& from, const Vec3f& direction, float time = 0) const;

  static constexpr float kFar = 1e30f;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace h2mc
