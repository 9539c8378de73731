// SPDX-License-Identifier: MIT
#include "render/geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/core/index.h"
#include "render/core/unit_interval.h"
namespace h2mc {
namespace {

constexpr double kTolerance = 1e-3;

float turnsOf(double y, double x) {
  const double t = std::atan2(y, x) / (2 * std::numbers::pi);
  return toUnitInterval(t < 0 ? t + 1 : t);
}

// Coordinates of p along two edges, and whether p is in their plane.
bool planeCoordinates(const glm::dvec3& e1, const glm::dvec3& e2, const glm::dvec3& p, double& a,
                      double& b) {
  const glm::dvec3 n = glm::cross(e1, e2);
  const double n2 = glm::dot(n, n);
  if (!(n2 > 0)) return false;
  a = glm::dot(p, glm::cross(e2, n)) / n2;
  b = glm::dot(p, glm::cross(n, e1)) / n2;
  const double size = std::sqrt(std::max(glm::dot(e1, e1), glm::dot(e2, e2)));
  return std::abs(glm::dot(p, n)) <= kTolerance * size * std::sqrt(n2);
}

bool inside(double x) { return x >= -kTolerance && x <= 1 + kTolerance; }

template <class P>
bool invertTriangle(const detail::Triangle<P>& triangle, const Vec3f& p, Vec2f& u) {
  double b1, b2;
  if (!planeCoordinates(triangle.ab, triangle.ac, glm::dvec3(p) - triangle.a, b1, b2)) return false;
  if (!inside(b1) || !inside(b2) || !inside(b1 + b2)) return false;
  b1 = std::clamp(b1, 0.0, 1.0);
  // b1 = 1 - sqrt(1 - u0), b2 = u1 sqrt(1 - u0)
  u = {toUnitInterval(b1 * (2 - b1)), b1 < 1 ? toUnitInterval(b2 / (1 - b1)) : 0.0f};
  return true;
}

// Of triangles (a, b, c) and (c, d, a).
template <class P>
bool invertParallelogram(const detail::Triangle<P>& triangle, const Vec3f& p, Vec2f& u) {
  double x, y;
  if (!planeCoordinates(triangle.ab, triangle.ac - triangle.ab, glm::dvec3(p) - triangle.a, x, y))
    return false;
  if (!inside(x) || !inside(y)) return false;
  u = {toUnitInterval(x), toUnitInterval(y)};
  return true;
}

bool invertSphere(const detail::SphereView<float>& sphere, const Vec3f& p, Vec2f& u) {
  const glm::dvec3 d = glm::dvec3(p) - sphere.exactCenter;
  const double distance = std::sqrt(glm::dot(d, d));
  if (!(std::abs(distance - static_cast<double>(sphere.radius)) <=
        kTolerance * static_cast<double>(sphere.radius)))
    return false;
  u = {toUnitInterval((1 - d.z / distance) / 2), turnsOf(d.y, d.x)};
  return true;
}

bool invertCylinder(const detail::CylinderView<float>& view, const Vec3f& p, Vec2f& u) {
  const glm::dvec3 way = glm::dvec3(p) - view.exactStart;
  const double z = glm::dot(way, view.exactAxis) / view.exactHeight;
  const glm::dvec3 across = way - view.exactAxis * (z * view.exactHeight);
  const double distance = std::sqrt(glm::dot(across, across));
  if (!(std::abs(distance - view.exactRadius) <= kTolerance * view.exactRadius) || !inside(z))
    return false;
  u = {toUnitInterval(z),
       turnsOf(glm::dot(across, glm::dvec3(view.y)), glm::dot(across, glm::dvec3(view.x)))};
  return true;
}

bool invertDisk(const detail::DiskView<float>& disk, const Vec3f& p, Vec2f& u) {
  double x, y;
  if (!planeCoordinates(disk.exactX, disk.exactY, glm::dvec3(p) - disk.exactCenter, x, y))
    return false;
  const double r2 = x * x + y * y;
  if (r2 > 1 + 2 * kTolerance) return false;
  u = {toUnitInterval(r2), turnsOf(y, x)};
  return true;
}

template <class P>
double triangleArea(const detail::Triangle<P>& triangle) {
  const glm::dvec3 n = glm::cross(triangle.ab, triangle.ac);
  return std::sqrt(glm::dot(n, n)) / 2;
}

double diskArea(const Disk& disk) {
  const glm::dvec3 n = glm::cross(glm::dvec3(disk.axisX), glm::dvec3(disk.axisY));
  return std::numbers::pi * std::sqrt(glm::dot(n, n));
}

double cylinderArea(const Cylinder& cylinder) {
  const glm::dvec3 way = glm::dvec3(cylinder.end) - glm::dvec3(cylinder.start);
  return 2 * std::numbers::pi * static_cast<double>(cylinder.radius) *
         std::sqrt(glm::dot(way, way));
}

double sphereArea(const Sphere& sphere) {
  const double radius = static_cast<double>(sphere.radius);
  return 4 * std::numbers::pi * radius * radius;
}

// The mean of f over a motion's steps, 0 .. segments.
template <class F>
double meanOverSteps(int segments, F&& f) {
  double sum = 0;
  for (int i = 0; i <= segments; ++i) sum += f(i);
  return sum / (segments + 1);
}

double meshTriangleArea(const Shape& shape, std::uint32_t index) {
  const int segments = shape.motionSegments();
  return meanOverSteps(segments, [&](int step) {
    const float time = segments ? static_cast<float>(step) / static_cast<float>(segments) : 0;
    return detail::withView<float>(shape, &time, [&](const auto& view) {
      if constexpr (requires { view.triangle(0); })
        return triangleArea(detail::triangleOf(view, index));
      else
        return 0.0;
    });
  });
}

}  // namespace

bool invertPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& p, Vec2f& u,
                     const float* time) {
  return detail::withView<float>(shapes[id.shape], time, [&](const auto& view) {
    if constexpr (requires { view.height; }) {
      return invertCylinder(view, p, u);
    } else if constexpr (requires { view.radius; }) {
      return invertSphere(view, p, u);
    } else if constexpr (requires { view.axisX; }) {
      return invertDisk(view, p, u);
    } else {
      return view.parallelogram() ? invertParallelogram(detail::triangleOf(view, 0), p, u)
                                  : invertTriangle(detail::triangleOf(view, id.primitive), p, u);
    }
  });
}

double totalArea(const Shape& shape) {
  if (shape.isMesh()) {
    double area = 0;
    for (std::uint32_t i = 0; i < shape.triangles().size(); ++i) area += meshTriangleArea(shape, i);
    return area;
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return sphereArea(*sphere);
  if (const auto* disk = std::get_if<Disk>(&shape.geometry)) return diskArea(*disk);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) return cylinderArea(*cylinder);
  return meanOverSteps(shape.motionSegments(), [&](int step) {
    const auto i = at(step);
    if (const auto* sphere = std::get_if<MovingSphere>(&shape.geometry))
      return sphereArea(sphere->steps[i]);
    if (const auto* cylinder = std::get_if<MovingCylinder>(&shape.geometry))
      return cylinderArea(cylinder->steps[i]);
    return diskArea(std::get<MovingDisk>(shape.geometry).steps[i]);
  });
}

double primitiveArea(const Shape& shape, std::uint32_t primitive) {
  if (!shape.isMesh()) return totalArea(shape);
  return shape.isParallelogram() ? totalArea(shape) : meshTriangleArea(shape, primitive);
}

}  // namespace h2mc
