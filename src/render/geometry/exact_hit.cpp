// SPDX-License-Identifier: MIT
#include "render/geometry/exact_hit.h"

#include <algorithm>
#include <cmath>

#include "render/geometry/surface.h"

namespace h2mc {
namespace {

bool hitSphere(const detail::SphereView<float>& sphere, const Segment& segment, double& t,
               std::uint32_t& root) {
  const glm::dvec3 toCenter = sphere.exactCenter - segment.origin;
  const double length2 = glm::dot(segment.direction, segment.direction);
  const double closest = glm::dot(toCenter, segment.direction) / length2;
  const glm::dvec3 perpendicular = toCenter - segment.direction * closest;
  const double radius = static_cast<double>(sphere.radius);
  const double discriminant = radius * radius - glm::dot(perpendicular, perpendicular);
  if (!(discriminant >= 0)) return false;
  const double half = std::sqrt(discriminant / length2);
  const double larger = closest >= 0 ? closest + half : closest - half;
  if (larger == 0) return false;
  const double smaller = (glm::dot(toCenter, toCenter) - radius * radius) / (larger * length2);
  const double roots[2] = {closest >= 0 ? smaller : larger, closest >= 0 ? larger : smaller};
  for (root = 0; root < 2; ++root) {
    t = roots[root];
    if (t > segment.near && t < segment.far) return true;
  }
  return false;
}

bool hitCylinder(const detail::CylinderView<float>& view, const Segment& segment, double& t,
                 std::uint32_t& root) {
  const glm::dvec3& axis = view.exactAxis;
  const glm::dvec3 start = segment.origin - view.exactStart;
  const double startAlong = glm::dot(start, axis), along = glm::dot(segment.direction, axis);
  const glm::dvec3 across = start - axis * startAlong, d = segment.direction - axis * along;
  const double d2 = glm::dot(d, d);
  if (!(d2 > 0)) return false;
  const double closest = -glm::dot(across, d) / d2;
  const glm::dvec3 perpendicular = across + d * closest;
  const double radius2 = view.exactRadius * view.exactRadius;
  const double discriminant = radius2 - glm::dot(perpendicular, perpendicular);
  if (!(discriminant >= 0)) return false;
  const double half = std::sqrt(discriminant / d2);
  const double larger = closest >= 0 ? closest + half : closest - half;
  if (larger == 0) return false;
  const double smaller = (glm::dot(across, across) - radius2) / (larger * d2);
  const double roots[2] = {closest >= 0 ? smaller : larger, closest >= 0 ? larger : smaller};
  for (root = 0; root < 2; ++root) {
    t = roots[root];
    const double z = startAlong + t * along;
    if (t > segment.near && t < segment.far && z >= 0 && z <= view.exactHeight) return true;
  }
  return false;
}

bool hitDisk(const detail::DiskView<float>& disk, const Segment& segment, double& t) {
  const glm::dvec3 &ax = disk.exactX, &ay = disk.exactY, n = glm::cross(ax, ay);
  const glm::dvec3 start = segment.origin - disk.exactCenter;
  t = -glm::dot(start, n) / glm::dot(segment.direction, n);
  if (!(t > segment.near && t < segment.far)) return false;
  const glm::dvec3 p = start + segment.direction * t;
  const double n2 = glm::dot(n, n);
  const double x = glm::dot(p, glm::cross(ay, n)) / n2, y = glm::dot(p, glm::cross(n, ax)) / n2;
  return x * x + y * y <= 1;
}

}  // namespace

bool hitRound(const Shape& shape, const Segment& segment, double& t, std::uint32_t& root) {
  root = 0;
  return detail::withView<float>(shape, &segment.time, [&](const auto& view) {
    if constexpr (requires { view.height; })
      return hitCylinder(view, segment, t, root);
    else if constexpr (requires { view.radius; })
      return hitSphere(view, segment, t, root);
    else if constexpr (requires { view.axisX; })
      return hitDisk(view, segment, t);
    else
      return false;
  });
}

bool hitTriangle(const Shape& shape, std::uint32_t triangle, const Segment& segment, double& t) {
  return detail::withView<float>(shape, &segment.time, [&](const auto& view) {
    if constexpr (requires { view.hasUvs(); }) {
      const glm::uvec3& corners = view.triangle(triangle);
      const glm::dvec3 a = view.exactPosition(corners.x) - segment.origin,
                       b = view.exactPosition(corners.y) - segment.origin,
                       c = view.exactPosition(corners.z) - segment.origin;
      const glm::dvec3& d = segment.direction;
      // On which side of the edges the line passes: Pluecker coordinates, from which both triangles at an edge
      // conclude the same.
      const double ab = glm::dot(d, glm::cross(a, b)), bc = glm::dot(d, glm::cross(b, c)),
                   ca = glm::dot(d, glm::cross(c, a));
      if (std::min({ab, bc, ca}) < 0 && std::max({ab, bc, ca}) > 0) return false;
      const glm::dvec3 n = glm::cross(b - a, c - a);
      t = glm::dot(a, n) / glm::dot(d, n);
      return t > segment.near && t < segment.far;
    } else {
      return false;
    }
  });
}

}  // namespace h2mc
