// SPDX-License-Identifier: MIT
// Points on primitives as functions of a ray or of primary coordinates, over any scalar type.
//
// The value of a point is the surface's own at the coordinates found (a combination of the
// triangle's corners, ...), summed in double: it lies within half an ulp of the surface however
// far the ray came. Its derivatives are those of the line's point, which is the same function.
// What belongs to the scene alone (edges, normals of flat triangles) is computed in plain numbers.
#pragma once

#include <span>

#include "render/geometry/shape.h"
#include "render/geometry/surface_cylinder.h"
#include "render/geometry/surface_disk.h"
#include "render/geometry/surface_point.h"
#include "render/geometry/surface_sphere.h"
#include "render/geometry/surface_triangle.h"

namespace h2mc {

namespace detail {

template <class T, class View>
SurfacePoint<T> intersectView(const View& view, std::uint32_t primitive, const Vec3<T>& origin,
                              const Vec3<T>& direction) {
  if constexpr (requires { view.height; })
    return intersectCylinder<T>(view, primitive, origin, direction);
  else if constexpr (requires {
                       view.center;
                       view.radius;
                     })
    return intersectSphere<T>(view, primitive, origin, direction);
  else if constexpr (requires { view.axisX; })
    return intersectDisk<T>(view, origin, direction);
  else
    return intersectTriangle<T>(view, primitive, origin, direction);
}

template <class T, class View>
SurfacePoint<T> sampleView(const View& view, std::uint32_t primitive, const T& u0, const T& u1) {
  if constexpr (requires { view.height; })
    return sampleCylinder<T>(view, u0, u1);
  else if constexpr (requires {
                       view.center;
                       view.radius;
                     })
    return sampleSphere<T>(view, u0, u1);
  else if constexpr (requires { view.axisX; })
    return sampleDisk<T>(view, u0, u1);
  else if (view.parallelogram())
    return sampleParallelogram<T>(view, u0, u1);
  else
    return sampleTriangle<T>(view, primitive, u0, u1);
}

template <class View>
auto areaOfView(const View& view, std::uint32_t primitive) {
  if constexpr (requires { view.height; }) {
    using P = decltype(view.radius);
    return P(view.radius * view.height * Scalar<P>(2 * std::numbers::pi));
  } else if constexpr (requires {
                         view.center;
                         view.radius;
                       }) {
    using P = decltype(view.radius);
    return P(view.radius * view.radius * Scalar<P>(4 * std::numbers::pi));
  } else if constexpr (requires { view.axisX; }) {
    using P = decltype(view.axisX.x);
    const double area = glm::length(glm::cross(view.exactX, view.exactY));
    if constexpr (!ad::isDual<P>) {
      return P(area * std::numbers::pi);
    } else {
      // Scaled to 1 before it is squared.
      using S = Scalar<P>;
      const Vec3<P> unit = cross(view.axisX, view.axisY) * S(1 / std::max(area, 1e-30));
      return P(sqrt(length2(unit)) * S(area * std::numbers::pi));
    }
  } else {
    const auto triangle = triangleOf(view, primitive);
    using P = decltype(triangle.inverseArea2);
    using S = Scalar<P>;
    // A triangle without area has no point to be sampled.
    if (!(value(triangle.inverseArea2) > 0)) return P(S(1e-30));
    return P(P(S(view.parallelogram() ? 1 : 0.5)) / triangle.inverseArea2);
  }
}

// Calls f with the shape's geometry as plain numbers, or as functions of `time`.
template <class T, class F>
auto withView(const Shape& shape, const T* time, F&& f) {
  using S = Scalar<T>;
  const Geometry& geometry = shape.geometry;
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) [[likely]]
    return f(StillMesh<S>(*mesh));
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return f(viewOf<S>(*sphere));
  if (const auto* disk = std::get_if<Disk>(&geometry)) return f(viewOf<S>(*disk));
  if (const auto* mesh = std::get_if<MovingMesh>(&geometry))
    return f(MeshAtMoment<T>(*mesh, *time));
  if (const auto* sphere = std::get_if<MovingSphere>(&geometry))
    return f(viewOf<T>(*sphere, *time));
  if (const auto* disk = std::get_if<MovingDisk>(&geometry)) return f(viewOf<T>(*disk, *time));
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) return f(viewOf<S>(*cylinder));
  if (const auto* instance = std::get_if<MeshInstance>(&geometry))
    return f(StillMesh<S>(*instance));
  if (const auto* instance = std::get_if<MovingMeshInstance>(&geometry))
    return f(MeshAtMoment<T>(*instance, *time));
  return f(viewOf<T>(*std::get_if<MovingCylinder>(&geometry), *time));
}

}  // namespace detail

// Where the line from `origin` along unit `direction` meets the primitive's (extended) surface: the
// plane of a triangle or disk, the chosen root of a sphere or of a cylinder that goes on beyond its ends. RayTracer's
// hits are recomputed, so that derivatives and values come from the same lines. Precondition: the ray is not parallel.
//
// `time`, here and below: the moment in [0, 1] of the shutter's opening. May be null if the shape does
// not move.
template <class T>
SurfacePoint<T> intersectPrimitive(std::span<const Shape> shapes, PrimitiveId id,
                                   const Vec3<T>& origin, const Vec3<T>& direction,
                                   const std::type_identity_t<T>* time = nullptr) {
  SurfacePoint<T> point = detail::withView<T>(shapes[id.shape], time, [&](const auto& view) {
    return detail::intersectView<T>(view, id.primitive, origin, direction);
  });
  point.shape = id.shape;
  return point;
}

// The same point by two coordinates on the surface, which pointOnPrimitive understands: what passes
// from one step along a path to the next. `around` is a point of the surface near by (the same for both
// functions, in the same scene at the same time): spheres have no coordinates that are good everywhere.
// `distance` is left with the length of the ray.
template <class T>
Vec2<T> coordinatesOnPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& around,
                               const Vec3<T>& origin, const Vec3<T>& direction, T& distance,
                               const std::type_identity_t<T>* time = nullptr) {
  return detail::withView<T>(shapes[id.shape], time, [&](const auto& view) -> Vec2<T> {
    if constexpr (requires { view.height; })
      return detail::cylinderCoordinates<T>(view, id.primitive, Vec3<Scalar<T>>(around), origin,
                                            direction, distance);
    else if constexpr (requires { view.radius; })
      return detail::chartAround(view, Vec3<Scalar<T>>(around))
          .coordinates(detail::meetSphere<T>(view, id.primitive, origin, direction, distance));
    else if constexpr (requires { view.axisX; })
      return detail::diskCoordinates<T>(view, origin, direction, distance);
    else
      return detail::triangleCoordinates<T>(view, id.primitive, origin, direction, distance);
  });
}

template <class T>
SurfacePoint<T> pointOnPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& around,
                                 const Vec2<T>& at, const std::type_identity_t<T>* time = nullptr) {
  SurfacePoint<T> point =
      detail::withView<T>(shapes[id.shape], time, [&](const auto& view) -> SurfacePoint<T> {
        if constexpr (requires { view.height; })
          return detail::cylinderPointAt<T>(view, Vec3<Scalar<T>>(around), at);
        else if constexpr (requires { view.radius; })
          return detail::spherePoint<T>(
              view, detail::chartAround(view, Vec3<Scalar<T>>(around)).direction(at));
        else if constexpr (requires { view.axisX; })
          return detail::diskPoint<T>(view, at.x, at.y);
        else
          return detail::trianglePointAt<T>(view, id.primitive, at);
      });
  point.shape = id.shape;
  return point;
}

// A point uniform by area on the primitive (on the whole shape for what is no mesh and for
// parallelograms) from u in [0,1)^2. Derivatives are finite everywhere; they grow without bound
// towards a triangle's corner (u0 -> 1), a sphere's poles and a disk's centre.
template <class T>
SurfacePoint<T> samplePrimitive(std::span<const Shape> shapes, PrimitiveId id, const T& u0,
                                const T& u1, const std::type_identity_t<T>* time = nullptr) {
  SurfacePoint<T> point = detail::withView<T>(shapes[id.shape], time, [&](const auto& view) {
    return detail::sampleView<T>(view, id.primitive, u0, u1);
  });
  point.shape = id.shape;
  return point;
}

// The inverse: coordinates with samplePrimitive(...) at `p`; false when `p` does not lie on the
// primitive (by more than a thousandth of its size).
bool invertPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& p, Vec2f& u,
                     const float* time = nullptr);

// Area of what samplePrimitive covers, as a function of time.
template <class T>
T primitiveAreaAt(const Shape& shape, std::uint32_t primitive, const T* time) {
  return detail::withView<T>(
      shape, time, [&](const auto& view) -> T { return T(detail::areaOfView(view, primitive)); });
}

// The same, in the mean over the steps of a motion; total area of a shape likewise.
double primitiveArea(const Shape& shape, std::uint32_t primitive);
double totalArea(const Shape& shape);

// Whether u1 of samplePrimitive is an angle, so that 0 and 1 are the same point.
inline bool wrapsAround(const Shape& shape) { return !shape.isMesh(); }

}  // namespace h2mc
