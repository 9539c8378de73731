// Points on primitives as functions of a ray or of primary coordinates, over any scalar type.
//
// The value of a point is the surface's own at the coordinates found (a combination of the
// triangle's corners, ...), summed in double: it lies within half an ulp of the surface however
// far the ray came. Its derivatives are those of the line's point, which is the same function.
// What belongs to the scene alone (edges, normals of flat triangles) is computed in plain numbers.
#pragma once

#include <span>

#include "render/geometry/shape.h"
#include "render/geometry/surface_disk.h"
#include "render/geometry/surface_point.h"
#include "render/geometry/surface_sphere.h"
#include "render/geometry/surface_triangle.h"

namespace h2mc {

// Where the line from `origin` along unit `direction` meets the primitive's (extended) surface: the
// plane of a triangle or disk, the chosen root of a sphere. What RayTracer found is recomputed here,
// so that derivatives and values come from the same lines. Precondition: the ray is not parallel.
template <class T>
SurfacePoint<T> intersectPrimitive(std::span<const Shape> shapes, PrimitiveId id,
                                   const Vec3<T>& origin, const Vec3<T>& direction) {
  const auto& geometry = shapes[id.shape].geometry;
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) [[likely]]
    return detail::intersectTriangle<T>(*mesh, id.primitive, origin, direction);
  if (const auto* sphere = std::get_if<Sphere>(&geometry))
    return detail::intersectSphere<T>(*sphere, id.primitive, origin, direction);
  return detail::intersectDisk<T>(*std::get_if<Disk>(&geometry), origin, direction);
}

// A point uniform by area on the primitive (on the whole shape for spheres, disks and
// parallelograms) from u in [0,1)^2. Derivatives are finite everywhere; they grow without bound
// towards a triangle's corner (u0 -> 1), a sphere's poles and a disk's centre.
template <class T>
SurfacePoint<T> samplePrimitive(std::span<const Shape> shapes, PrimitiveId id, const T& u0,
                                const T& u1) {
  const auto& geometry = shapes[id.shape].geometry;
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) [[likely]] {
    if (mesh->parallelogram) return detail::sampleParallelogram<T>(*mesh, u0, u1);
    return detail::sampleTriangle<T>(*mesh, id.primitive, u0, u1);
  }
  if (const auto* sphere = std::get_if<Sphere>(&geometry))
    return detail::sampleSphere<T>(*sphere, u0, u1);
  return detail::sampleDisk<T>(*std::get_if<Disk>(&geometry), u0, u1);
}

// The inverse: coordinates with samplePrimitive(...) at `p`; false when `p` does not lie on the
// primitive (by more than a thousandth of its size).
bool invertPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& p, Vec2f& u);

// Area of what samplePrimitive covers; total area of a shape.
double primitiveArea(const Shape& shape, std::uint32_t primitive);
double totalArea(const Shape& shape);

// Whether u1 of samplePrimitive is an angle, so that 0 and 1 are the same point.
inline bool wrapsAround(const Shape& shape) {
  return !std::holds_alternative<TriangleMesh>(shape.geometry);
}

}  // namespace h2mc
