// SPDX-License-Identifier: MIT
#include "render/geometry/round_meshes.h"

#include <cmath>
#include <numbers>

namespace h2mc {
namespace {

constexpr double kNoise = 1e-4;  // of matrices written with few digits

bool isNear(double a, double b) { return std::abs(a - b) <= kNoise * std::abs(b); }
bool isAcross(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(glm::dot(a, b)) <= kNoise * glm::length(a) * glm::length(b);
}

}  // namespace

MeshData makeUnitSphere() {
  constexpr unsigned kRings = 128, kSectors = 256;
  MeshData mesh;
  for (unsigned i = 0; i <= kRings; ++i)
    for (unsigned j = 0; j <= kSectors; ++j) {
      const double theta = std::numbers::pi * i / kRings, phi = 2 * std::numbers::pi * j / kSectors;
      const glm::dvec3 p(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
      mesh.positions.emplace_back(p);
      mesh.normals.emplace_back(p);
      mesh.uvs.emplace_back(static_cast<float>(j) / kSectors, static_cast<float>(i) / kRings);
    }
  for (unsigned i = 0; i < kRings; ++i)
    for (unsigned j = 0; j < kSectors; ++j) {
      const unsigned a = i * (kSectors + 1) + j, b = a + kSectors + 1;
      if (i + 1 < kRings) mesh.triangles.emplace_back(a, b, b + 1);
      if (i > 0) mesh.triangles.emplace_back(a, b + 1, a + 1);
    }
  return mesh;
}

MeshData makeUnitCylinder() {
  constexpr unsigned kSectors = 1024;
  MeshData mesh;
  for (unsigned j = 0; j <= kSectors; ++j) {
    const double phi = 2 * std::numbers::pi * (j % kSectors) / kSectors;
    for (const float z : {0.f, 1.f}) {
      const glm::dvec3 n(std::cos(phi), std::sin(phi), 0);
      mesh.positions.emplace_back(static_cast<float>(n.x), static_cast<float>(n.y), z);
      mesh.normals.emplace_back(n);
      mesh.uvs.emplace_back(static_cast<float>(j) / kSectors, z);
    }
    if (j == kSectors) break;
    mesh.triangles.emplace_back(2 * j, 2 * j + 2, 2 * j + 3);
    mesh.triangles.emplace_back(2 * j, 2 * j + 3, 2 * j + 1);
  }
  return mesh;
}

std::optional<double> uniformScale(const glm::dmat3& linear) {
  const double scale = glm::length(linear[0]);
  for (int i = 0; i < 3; ++i)
    if (!isNear(glm::length(linear[i]), scale) || !isAcross(linear[i], linear[(i + 1) % 3]))
      return std::nullopt;
  return scale;
}

std::optional<double> roundScale(const glm::dmat3& linear, const glm::dvec3& axis,
                                 const glm::dvec3& across) {
  const glm::dvec3 a = linear * axis, x = linear * across, y = linear * glm::cross(axis, across);
  const double scale = glm::length(x);
  if (!isNear(glm::length(y), scale) || !isAcross(x, y) || !isAcross(a, x) || !isAcross(a, y))
    return std::nullopt;
  return scale;
}

}  // namespace h2mc
