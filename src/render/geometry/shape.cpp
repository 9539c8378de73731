// SPDX-License-Identifier: MIT
#include "render/geometry/shape.h"

#include <algorithm>
#include <cmath>

namespace h2mc {
namespace {

template <class Steps>
int segmentsOf(const Steps& steps) {
  return static_cast<int>(steps.size()) - 1;
}

}  // namespace

SharedMesh::SharedMesh(TriangleMesh triangles) : mesh(std::move(triangles)) {
  mesh.parallelogram = false;
  if (mesh.positions.empty()) return;
  low = high = mesh.positions[0];
  for (const Vec3f& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<float> longest;
  longest.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) {
    const Vec3f &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    longest.push_back(std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)}));
  }
  if (longest.empty()) return;
  longestEdge = *std::max_element(longest.begin(), longest.end());
  const auto middle = longest.begin() + static_cast<long>(longest.size() / 2);
  std::nth_element(longest.begin(), middle, longest.end());
  medianEdge = *middle;
}

int Shape::motionSegments() const {
  if (const auto* mesh = std::get_if<MovingMesh>(&geometry)) return mesh->segments;
  if (const auto* sphere = std::get_if<MovingSphere>(&geometry)) return segmentsOf(sphere->steps);
  if (const auto* disk = std::get_if<MovingDisk>(&geometry)) return segmentsOf(disk->steps);
  if (const auto* cylinder = std::get_if<MovingCylinder>(&geometry))
    return segmentsOf(cylinder->steps);
  if (const auto* instance = std::get_if<MovingMeshInstance>(&geometry))
    return segmentsOf(instance->steps);
  return 0;
}

std::span<const glm::uvec3> Shape::triangles() const {
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) return mesh->triangles;
  if (const auto* mesh = std::get_if<MovingMesh>(&geometry)) return mesh->triangles;
  if (const auto* shared = sharedMesh()) return shared->mesh.triangles;
  return {};
}

const SharedMesh* Shape::sharedMesh() const {
  if (const auto* instance = std::get_if<MeshInstance>(&geometry)) return instance->shared.get();
  const auto* moving = std::get_if<MovingMeshInstance>(&geometry);
  return moving ? moving->shared.get() : nullptr;
}

std::span<const Placement> Shape::placements() const {
  if (const auto* instance = std::get_if<MeshInstance>(&geometry)) return {&instance->placement, 1};
  if (const auto* moving = std::get_if<MovingMeshInstance>(&geometry)) return moving->steps;
  return {};
}

bool Shape::isParallelogram() const {
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) return mesh->parallelogram;
  const auto* mesh = std::get_if<MovingMesh>(&geometry);
  return mesh && mesh->parallelogram;
}

}  // namespace h2mc
