// Points on triangles.
#pragma once

#include "render/core/safe_math.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc::detail {

// A triangle of a mesh: everything here is scene data, so plain numbers.
template <class S>
struct Triangle {
  Vec3<S> p0, e1, e2;  // a corner and the edges from it
  Vec3<S> normal;      // unit, by the order of the corners; zero if the triangle has no area
  S inverseArea2;      // 1 / |e1 x e2|
};

template <class S>
Triangle<S> triangleOf(const TriangleMesh& mesh, std::uint32_t index) {
  const glm::uvec3& t = mesh.triangles[index];
  const Vec3f &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
  Triangle<S> r;
  r.p0 = Vec3<S>(a);
  r.e1 = Vec3<S>(b) - Vec3<S>(a);
  r.e2 = Vec3<S>(c) - Vec3<S>(a);
  // In double: a cross product of small edges would underflow, of slivers cancel.
  const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  const double n2 = glm::dot(n, n);
  const double inverse = n2 > 0 ? 1 / std::sqrt(n2) : 0;
  r.normal = Vec3<S>(n * inverse);
  r.inverseArea2 = S(inverse);
  return r;
}

// The point with barycentric coordinates b1, b2 to within half an ulp, however large the triangle
// is: any rounding in b1 and b2 moves it along the triangle only.
template <class S>
Vec3<S> pointOnTriangle(const TriangleMesh& mesh, std::uint32_t index, S b1, S b2) {
  const glm::uvec3& t = mesh.triangles[index];
  const glm::dvec3 a(mesh.positions[t.x]);
  return Vec3<S>(a + (glm::dvec3(mesh.positions[t.y]) - a) * static_cast<double>(b1) +
                 (glm::dvec3(mesh.positions[t.z]) - a) * static_cast<double>(b2));
}

// Sets normals, frame and texture coordinates at barycentric coordinates b1, b2.
template <class T>
void finishTrianglePoint(const TriangleMesh& mesh, std::uint32_t index, Vec3<Scalar<T>> normal,
                         const T& b1, const T& b2, SurfacePoint<T>& r) {
  using S = Scalar<T>;
  const glm::uvec3& t = mesh.triangles[index];
  bool flat = true;
  Vec3<S> passive = normal;
  if (!mesh.normals.empty()) {
    const Vec3f &n0 = mesh.normals[t.x], &n1 = mesh.normals[t.y], &n2 = mesh.normals[t.z];
    if (n0 == n1 && n0 == n2) {
      if (glm::dot(n0, n0) > 0.5f) passive = Vec3<S>(n0);
    } else {
      const Vec3<S> a = plain<T>(n0), d1 = plain<T>(n1) - a, d2 = plain<T>(n2) - a;
      const Vec3<T> n{linear2(b1, d1.x, b2, d2.x) + a.x, linear2(b1, d1.y, b2, d2.y) + a.y,
                      linear2(b1, d1.z, b2, d2.z) + a.z};
      if (dot(value3(n), value3(n)) > S(1e-6)) {
        flat = false;
        r.shading = Frame<T>::fromNormal(ad::normalize(n));
        if (dot(normal, value3(r.shading.n)) < 0) normal = -normal;
      }
    }
  }
  if (flat) {
    if (dot(normal, passive) < 0) normal = -normal;
    const Frame<S> frame = Frame<S>::fromNormal(passive);
    r.shading = {lift<T>(frame.s), lift<T>(frame.t), lift<T>(frame.n)};
  }
  r.ng = lift<T>(normal);
  if (mesh.uvs.empty()) {
    r.uv = {b1, b2};
  } else {
    const Vec2f &a = mesh.uvs[t.x], &b = mesh.uvs[t.y], &c = mesh.uvs[t.z];
    const auto coordinate = [&](float x0, float x1, float x2) -> T {
      return linear2(b1, S(x1) - S(x0), b2, S(x2) - S(x0)) + S(x0);
    };
    r.uv = {coordinate(a.x, b.x, c.x), coordinate(a.y, b.y, c.y)};
  }
}

template <class T>
SurfacePoint<T> trianglePoint(const TriangleMesh& mesh, std::uint32_t index, const T& b1,
                              const T& b2) {
  using S = Scalar<T>;
  const Triangle<S> triangle = triangleOf<S>(mesh, index);
  SurfacePoint<T> r;
  r.p = {linear2(b1, triangle.e1.x, b2, triangle.e2.x),
         linear2(b1, triangle.e1.y, b2, triangle.e2.y),
         linear2(b1, triangle.e1.z, b2, triangle.e2.z)};
  r.p = withValue<T>(r.p, pointOnTriangle<S>(mesh, index, value(b1), value(b2)));
  finishTrianglePoint<T>(mesh, index, triangle.normal, b1, b2, r);
  return r;
}

template <class T>
SurfacePoint<T> intersectTriangle(const TriangleMesh& mesh, std::uint32_t index,
                                  const Vec3<T>& origin, const Vec3<T>& direction) {
  using S = Scalar<T>;
  const Triangle<S> triangle = triangleOf<S>(mesh, index);
  // Relative to a corner, so that everything below is of the triangle's own magnitude.
  const Vec3<T> start = origin - triangle.p0;
  const T t = -dot(start, triangle.normal) / dot(direction, triangle.normal);
  const Vec3<T> p = start + direction * t;
  // b1 and b2 are linear in p: the edges' dual basis.
  const Vec3<S> dual1 = cross(triangle.e2, triangle.normal) * triangle.inverseArea2;
  const Vec3<S> dual2 = cross(triangle.normal, triangle.e1) * triangle.inverseArea2;
  const T b1 = dot(p, dual1), b2 = dot(p, dual2);
  SurfacePoint<T> r;
  r.p = withValue<T>(p, pointOnTriangle<S>(mesh, index, value(b1), value(b2)));
  finishTrianglePoint<T>(mesh, index, triangle.normal, b1, b2, r);
  return r;
}

// Uniform by area. Derivatives are singular towards u0 = 1 only, where the triangle narrows to a
// corner.
template <class T>
SurfacePoint<T> sampleTriangle(const TriangleMesh& mesh, std::uint32_t index, const T& u0,
                               const T& u1) {
  using S = Scalar<T>;
  const T root = safeSqrt(T(S(1) - u0));
  return trianglePoint<T>(mesh, index, T(S(1) - root), T(u1 * root));
}

// p = a + u0 (b - a) + u1 (d - a) over the parallelogram of triangles (a, b, c) and (c, d, a).
template <class T>
SurfacePoint<T> sampleParallelogram(const TriangleMesh& mesh, const T& u0, const T& u1) {
  using S = Scalar<T>;
  if (value(u0) >= value(u1)) return trianglePoint<T>(mesh, 0, T(u0 - u1), u1);
  return trianglePoint<T>(mesh, 1, T(u1 - u0), T(S(1) - u1));
}

}  // namespace h2mc::detail
