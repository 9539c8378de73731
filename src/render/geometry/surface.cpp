#include "render/geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace h2mc {
namespace {

constexpr double kTolerance = 1e-3;

float coordinate(double x) { return std::clamp(static_cast<float>(x), 0.0f, 0x1.fffffep-1f); }

float turnsOf(double y, double x) {
  const double t = std::atan2(y, x) / (2 * std::numbers::pi);
  return coordinate(t < 0 ? t + 1 : t);
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

bool invertTriangle(const TriangleMesh& mesh, std::uint32_t index, const Vec3f& p, Vec2f& u) {
  const glm::uvec3& t = mesh.triangles[index];
  const glm::dvec3 a(mesh.positions[t.x]);
  double b1, b2;
  if (!planeCoordinates(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a,
                        glm::dvec3(p) - a, b1, b2))
    return false;
  if (!inside(b1) || !inside(b2) || !inside(b1 + b2)) return false;
  b1 = std::clamp(b1, 0.0, 1.0);
  // b1 = 1 - sqrt(1 - u0), b2 = u1 sqrt(1 - u0)
  u = {coordinate(b1 * (2 - b1)), b1 < 1 ? coordinate(b2 / (1 - b1)) : 0.0f};
  return true;
}

bool invertParallelogram(const TriangleMesh& mesh, const Vec3f& p, Vec2f& u) {
  const glm::dvec3 a(mesh.positions[mesh.triangles[0].x]);
  double x, y;
  if (!planeCoordinates(glm::dvec3(mesh.positions[mesh.triangles[0].y]) - a,
                        glm::dvec3(mesh.positions[mesh.triangles[1].y]) - a, glm::dvec3(p) - a, x,
                        y))
    return false;
  if (!inside(x) || !inside(y)) return false;
  u = {coordinate(x), coordinate(y)};
  return true;
}

bool invertSphere(const Sphere& sphere, const Vec3f& p, Vec2f& u) {
  const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(sphere.center);
  const double distance = std::sqrt(glm::dot(d, d));
  if (!(std::abs(distance - static_cast<double>(sphere.radius)) <=
        kTolerance * static_cast<double>(sphere.radius)))
    return false;
  u = {coordinate((1 - d.z / distance) / 2), turnsOf(d.y, d.x)};
  return true;
}

bool invertDisk(const Disk& disk, const Vec3f& p, Vec2f& u) {
  double x, y;
  if (!planeCoordinates(glm::dvec3(disk.axisX), glm::dvec3(disk.axisY),
                        glm::dvec3(p) - glm::dvec3(disk.center), x, y))
    return false;
  const double r2 = x * x + y * y;
  if (r2 > 1 + 2 * kTolerance) return false;
  u = {coordinate(r2), turnsOf(y, x)};
  return true;
}

double triangleArea(const TriangleMesh& mesh, std::size_t index) {
  const glm::uvec3& t = mesh.triangles[index];
  const glm::dvec3 a(mesh.positions[t.x]);
  const glm::dvec3 n =
      glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
  return std::sqrt(glm::dot(n, n)) / 2;
}

}  // namespace

bool invertPrimitive(std::span<const Shape> shapes, PrimitiveId id, const Vec3f& p, Vec2f& u) {
  const auto& geometry = shapes[id.shape].geometry;
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry))
    return mesh->parallelogram ? invertParallelogram(*mesh, p, u)
                               : invertTriangle(*mesh, id.primitive, p, u);
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return invertSphere(*sphere, p, u);
  return invertDisk(std::get<Disk>(geometry), p, u);
}

double totalArea(const Shape& shape) {
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
    double area = 0;
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) area += triangleArea(*mesh, i);
    return area;
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    const double radius = static_cast<double>(sphere->radius);
    return 4 * std::numbers::pi * radius * radius;
  }
  const auto& disk = std::get<Disk>(shape.geometry);
  const glm::dvec3 n = glm::cross(glm::dvec3(disk.axisX), glm::dvec3(disk.axisY));
  return std::numbers::pi * std::sqrt(glm::dot(n, n));
}

double primitiveArea(const Shape& shape, std::uint32_t primitive) {
  const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
  if (mesh && !mesh->parallelogram) return triangleArea(*mesh, primitive);
  return totalArea(shape);
}

}  // namespace h2mc
