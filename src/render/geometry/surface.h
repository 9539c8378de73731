// Points on primitives as functions of a ray or of primary coordinates, over any scalar type.
#pragma once

#include <span>

#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc {

// Where the line from `origin` along unit `direction` meets the primitive's (extended) surface: the
// plane of a triangle or disk, the chosen root of a sphere. What RayTracer found is recomputed here,
// so that derivatives and values come from the same lines. Precondition: the ray is not parallel.
// (template; defined in surface_inl.h or here)
template <class T>
SurfacePoint<T> intersectPrimitive(std::span<const Shape> shapes, PrimitiveId id,
                                   const Vec3<T>& origin, const Vec3<T>& direction);

// A point uniform by area on the primitive (on the whole shape for spheres, disks and
// parallelograms) from u in [0,1)^2.
template <class T>
SurfacePoint<T> samplePrimitive(std::span<const Shape> shapes, PrimitiveId id, const T& u0,
                                const T& u1);

// The inverse: coordinates with samplePrimitive(...) at `p`, which lies on the primitive.
bool invertPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& p, Vec2f& u);

// Area of what samplePrimitive covers; total area of a shape.
double primitiveArea(const Shape& shape, std::uint32_t primitive);
double totalArea(const Shape& shape);

}  // namespace h2mc
