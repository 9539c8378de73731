// SPDX-License-Identifier: MIT
// Points on triangles.
#pragma once

#include "render/core/safe_math.h"
#include "render/geometry/mesh_place.h"
#include "render/geometry/mesh_view.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// A triangle of a mesh: plain numbers where it stands still, functions of time where it moves.
template <class P>
struct Triangle {
  Vec3<P> p0, e1, e2;    // a corner and the edges from it
  Vec3<P> normal;        // unit, by the order of the corners; zero if the triangle has no area
  P inverseArea2;        // 1 / |e1 x e2|
  glm::dvec3 a, ab, ac;  // values of p0, e1, e2
  glm::dvec3 across;     // value of `normal`
  double scale;          // of inverseArea2
};

template <class View>
auto triangleOf(const View& mesh, std::uint32_t index) {
  using P = typename View::P;
  using S = Scalar<P>;
  const glm::uvec3& t = mesh.triangle(index);
  Triangle<P> r;
  r.a = mesh.exactPosition(t.x);
  r.ab = mesh.exactPosition(t.y) - r.a;
  r.ac = mesh.exactPosition(t.z) - r.a;
  // In double: a cross product of small edges would underflow, of slivers cancel.
  const glm::dvec3 n = glm::cross(r.ab, r.ac);
  const double n2 = glm::dot(n, n);
  const double inverse = n2 > 0 ? 1 / std::sqrt(n2) : 0;
  r.across = n * inverse;
  r.scale = inverse;
  r.p0 = mesh.position(t.x);
  r.e1 = mesh.position(t.y) - r.p0;
  r.e2 = mesh.position(t.z) - r.p0;
  if constexpr (ad::isDual<P>) {
    // The derivatives, scaled so that everything is of the order of 1.
    const S scale1 = S(1 / std::max(glm::length(r.ab), 1e-30));
    const S scale2 = S(std::min(inverse / static_cast<double>(scale1), 1e30));
    const Vec3<P> scaled = cross(r.e1 * scale1, r.e2) * scale2;  // of length 1, by value
    const P shrink = ad::rsqrt(length2(scaled));
    r.normal = withValue(scaled * shrink, Vec3<S>(r.across));
    r.inverseArea2 = shrink * S(inverse);
  } else {
    r.normal = Vec3<S>(r.across);
    r.inverseArea2 = S(inverse);
  }
  return r;
}

// The point with barycentric coordinates b1, b2 to within half an ulp, however large the triangle
// is: any rounding in b1 and b2 moves it along the triangle only.
template <class P>
Vec3<Scalar<P>> pointOnTriangle(const Triangle<P>& triangle, double b1, double b2) {
  return Vec3<Scalar<P>>(triangle.a + triangle.ab * b1 + triangle.ac * b2);
}

// Sets normals, frame and texture coordinates at barycentric coordinates b1, b2.
template <class T, class View>
void finishTrianglePoint(const View& mesh, std::uint32_t index, Vec3<typename View::P> normal,
                         const T& b1, const T& b2, SurfacePoint<T>& r) {
  using P = typename View::P;
  using S = Scalar<T>;
  const glm::uvec3& t = mesh.triangle(index);
  bool interpolated = false;
  Vec3<P> passive = normal;
  r.flat = !mesh.hasNormals();
  if (!r.flat) {
    if (mesh.sameNormals(t)) {
      Vec3<P> n = mesh.normal(t.x);
      if (dot(value3(n), value3(n)) > S(0.5)) {
        // Of unit length in float; directions must be so in their own precision.
        if constexpr (std::is_same_v<S, double>) n = ad::normalize(n);
        passive = n;
      }
    } else {
      const Vec3<P> a = mesh.normal(t.x), d1 = mesh.normal(t.y) - a, d2 = mesh.normal(t.z) - a;
      const Vec3<T> n{weighted2(b1, d1.x, b2, d2.x) + a.x, weighted2(b1, d1.y, b2, d2.y) + a.y,
                      weighted2(b1, d1.z, b2, d2.z) + a.z};
      if (dot(value3(n), value3(n)) > S(1e-6)) {
        interpolated = true;
        r.shading = Frame<T>::fromNormal(ad::normalize(n));
        if (dot(value3(normal), value3(r.shading.n)) < 0) normal = -normal;
      }
    }
  }
  if (!interpolated) {
    if (dot(value3(normal), value3(passive)) < 0) normal = -normal;
    r.shading.assign(Frame<P>::fromNormal(passive));
  }
  r.ng = liftFrom<T>(normal);
  r.constantNormal = !ad::isDual<P>;
  if (const std::uint32_t columns = mesh.placeColumns()) [[unlikely]] {
    // By the corners' own order.
    r.uv = mesh.mirrored() ? MeshPlace::of(index, columns, b2, b1)
                           : MeshPlace::of(index, columns, b1, b2);
  } else if (!mesh.hasUvs()) {
    r.uv = {b1, b2};
  } else {
    const Vec2f &a = mesh.uv(t.x), &b = mesh.uv(t.y), &c = mesh.uv(t.z);
    const auto coordinate = [&](float x0, float x1, float x2) -> T {
      return linear2(b1, S(x1) - S(x0), b2, S(x2) - S(x0)) + S(x0);
    };
    r.uv = {coordinate(a.x, b.x, c.x), coordinate(a.y, b.y, c.y)};
  }
}

template <class T, class View>
SurfacePoint<T> trianglePoint(const View& mesh, std::uint32_t index, const T& b1, const T& b2) {
  const auto triangle = triangleOf(mesh, index);
  SurfacePoint<T> r;
  r.p = {weighted2(b1, triangle.e1.x, b2, triangle.e2.x),
         weighted2(b1, triangle.e1.y, b2, triangle.e2.y),
         weighted2(b1, triangle.e1.z, b2, triangle.e2.z)};
  if constexpr (ad::isDual<typename View::P>) r.p = r.p + triangle.p0;
  setValue(r.p, pointOnTriangle(triangle, double(value(b1)), double(value(b2))));
  finishTrianglePoint<T>(mesh, index, triangle.normal, b1, b2, r);
  return r;
}

// Where a line meets the triangle's plane: values in double, since triangles may be far larger than what stands
// on them.
struct PlaneHit {
  double distance;  // along the line
  double b1, b2;    // barycentric coordinates
};

template <class P, class S>
PlaneHit meetPlane(const Triangle<P>& triangle, const Vec3<S>& origin, const Vec3<S>& direction) {
  const glm::dvec3 start = glm::dvec3(origin) - triangle.a, along(direction);
  PlaneHit hit;
  hit.distance = -glm::dot(start, triangle.across) / glm::dot(along, triangle.across);
  const glm::dvec3 p = glm::cross(start + along * hit.distance, triangle.across) * triangle.scale;
  hit.b1 = -glm::dot(p, triangle.ac);
  hit.b2 = glm::dot(p, triangle.ab);
  return hit;
}

// The same as a function: the point that is there by value, which the triangle takes along if it moves, and the way
// from it to where the line meets the plane. That is zero by value, so that no digits are lost where the triangle is
// far larger than the distance.
template <class T, class P>
struct PlanePoint {
  PlaneHit hit;
  Vec3<P> point;  // relative to the corner p0
  Vec3<T> way;
  T distance;

  PlanePoint(const Triangle<P>& triangle, const Vec3<T>& origin, const Vec3<T>& direction)
      : hit(meetPlane(triangle, value3(origin), value3(direction))) {
    using S = Scalar<T>;
    Vec3<T> start = origin;
    if constexpr (ad::isDual<P>) {
      point = triangle.e1 * S(hit.b1) + triangle.e2 * S(hit.b2);
      start = start - (triangle.p0 + point);
    } else {
      point = Vec3<S>(triangle.ab * hit.b1 + triangle.ac * hit.b2);
    }
    setValue(start, Vec3<S>(glm::dvec3(value3(direction)) * -hit.distance));
    distance = -dot(start, triangle.normal) / dot(direction, triangle.normal);
    way = start + direction * distance;
  }
};

template <class T, class View>
SurfacePoint<T> intersectTriangle(const View& mesh, std::uint32_t index, const Vec3<T>& origin,
                                  const Vec3<T>& direction) {
  const auto triangle = triangleOf(mesh, index);
  SurfacePoint<T> r;
  if constexpr (ad::isDual<T>) {
    using S = Scalar<T>;
    const PlanePoint meets(triangle, origin, direction);
    // b1 and b2 are linear in the point: the edges' dual basis.
    const auto dual1 = cross(triangle.e2, triangle.normal) * triangle.inverseArea2;
    const auto dual2 = cross(triangle.normal, triangle.e1) * triangle.inverseArea2;
    T b1 = dot(meets.way, dual1), b2 = dot(meets.way, dual2);
    b1.v = S(meets.hit.b1);
    b2.v = S(meets.hit.b2);
    r.p = meets.way;
    if constexpr (ad::isDual<typename View::P>) r.p = r.p + (triangle.p0 + meets.point);
    setValue(r.p, pointOnTriangle(triangle, meets.hit.b1, meets.hit.b2));
    finishTrianglePoint<T>(mesh, index, triangle.normal, b1, b2, r);
  } else {
    const PlaneHit hit = meetPlane(triangle, origin, direction);
    r.p = pointOnTriangle(triangle, hit.b1, hit.b2);
    finishTrianglePoint<T>(mesh, index, triangle.normal, T(hit.b1), T(hit.b2), r);
  }
  return r;
}

// Coordinates in the triangle's plane: lengths along its first edge and across it, from corner p0. Well
// conditioned however thin the triangle is.
template <class P>
struct PlaneAxes {
  Vec3<P> x, y;
  explicit PlaneAxes(const Triangle<P>& triangle) {
    using S = Scalar<P>;
    const S scale = S(1 / std::max(glm::length(triangle.ab), 1e-30));
    x = ad::normalize(Vec3<P>(triangle.e1 * scale));
    y = cross(triangle.normal, x);
  }
};

template <class T, class View>
Vec2<T> triangleCoordinates(const View& mesh, std::uint32_t index, const Vec3<T>& origin,
                            const Vec3<T>& direction, T& distance) {
  const auto triangle = triangleOf(mesh, index);
  const PlaneAxes axes(triangle);
  const PlanePoint meets(triangle, origin, direction);
  distance = meets.distance;
  const auto along = [&](const auto& axis) -> T {
    if constexpr (ad::isDual<typename View::P>)
      return dot(meets.way + meets.point, axis);
    else
      return dot(meets.way, axis) + dot(meets.point, axis);
  };
  return {along(axes.x), along(axes.y)};
}

template <class T, class View>
SurfacePoint<T> trianglePointAt(const View& mesh, std::uint32_t index, const Vec2<T>& at) {
  const auto triangle = triangleOf(mesh, index);
  const PlaneAxes axes(triangle);
  const auto dual1 = cross(triangle.e2, triangle.normal) * triangle.inverseArea2;
  const auto dual2 = cross(triangle.normal, triangle.e1) * triangle.inverseArea2;
  const T b1 = weighted2(at.x, dot(axes.x, dual1), at.y, dot(axes.y, dual1));
  const T b2 = weighted2(at.x, dot(axes.x, dual2), at.y, dot(axes.y, dual2));
  SurfacePoint<T> r;
  r.p = {weighted2(at.x, axes.x.x, at.y, axes.y.x), weighted2(at.x, axes.x.y, at.y, axes.y.y),
         weighted2(at.x, axes.x.z, at.y, axes.y.z)};
  if constexpr (ad::isDual<typename View::P>) r.p = r.p + triangle.p0;
  setValue(r.p, pointOnTriangle(triangle, double(value(b1)), double(value(b2))));
  finishTrianglePoint<T>(mesh, index, triangle.normal, b1, b2, r);
  return r;
}

// Uniform by area. Derivatives are singular towards u0 = 1 only, where the triangle narrows to a
// corner.
template <class T, class View>
SurfacePoint<T> sampleTriangle(const View& mesh, std::uint32_t index, const T& u0, const T& u1) {
  using S = Scalar<T>;
  const T root = safeSqrt(T(S(1) - u0));
  return trianglePoint<T>(mesh, index, T(S(1) - root), T(u1 * root));
}

// p = a + u0 (b - a) + u1 (d - a) over the parallelogram of triangles (a, b, c) and (c, d, a).
template <class T, class View>
SurfacePoint<T> sampleParallelogram(const View& mesh, const T& u0, const T& u1) {
  using S = Scalar<T>;
  if (value(u0) >= value(u1)) return trianglePoint<T>(mesh, 0, T(u0 - u1), u1);
  return trianglePoint<T>(mesh, 1, T(u1 - u0), T(S(1) - u1));
}

}  // namespace h2mc::detail
