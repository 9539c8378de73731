// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "render/geometry/mesh_data.h"

namespace h2mc {
namespace {

bool finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The vertices' normals as means of the faces around them, weighted by the angle at the vertex
// [Thuermer, Wuethrich 1998, "Computing Vertex Normals from Polygonal Facets"].
std::vector<Vec3f> computeNormals(const std::vector<Vec3f>& positions,
                                  const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
  for (const glm::uvec3& t : triangles) {
    const glm::dvec3 p[3] = {glm::dvec3(positions[t.x]), glm::dvec3(positions[t.y]),
                             glm::dvec3(positions[t.z])};
    const glm::dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(cross);
    if (!(length > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
      const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      sums[t[i]] += cross * (angle / length);
    }
  }
  std::vector<Vec3f> normals(positions.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = glm::length(sums[i]);
    normals[i] = length > 0 ? Vec3f(sums[i] / length) : Vec3f(0);
  }
  // Where faces cancel, or none has area: some face's own normal, so that it is never zero.
  for (const glm::uvec3& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      Vec3f& n = normals[t[i]];
      if (n.x != 0 || n.y != 0 || n.z != 0) continue;
      const glm::dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
      const glm::dvec3 cross = glm::cross(b - a, c - a);
      if (glm::length(cross) > 0) n = Vec3f(glm::normalize(cross));
    }
  }
  for (Vec3f& n : normals)
    if (n.x == 0 && n.y == 0 && n.z == 0) n = Vec3f(1, 0, 0);
  return normals;
}

bool hasArea(const Vec3f* positions, const glm::uvec3& t) {
  if (t.x == t.y || t.y == t.z || t.z == t.x) return false;
  const glm::dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
  const double longest =
      std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return glm::length(glm::cross(b - a, c - a)) > 1e-9 * longest && longest > 1e-30;
}

// Leaves out the triangles that have no area at any of `steps` moments, whose vertices stand one after
// the other, and returns how many; then the vertices that no triangle uses: the scene's bounds should
// not see them. For TriangleMesh and MovingMesh.
template <class Mesh>
std::size_t compact(Mesh& mesh, std::size_t steps) {
  const std::size_t vertices = mesh.positions.size() / steps;
  const std::size_t dropped = std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
    for (std::size_t k = 0; k < steps; ++k)
      if (hasArea(mesh.positions.data() + k * vertices, t)) return false;
    return true;
  });
  constexpr unsigned kUnused = ~0u;
  std::vector<unsigned> index(vertices, kUnused);
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) index[t[i]] = 0;
  unsigned count = 0;
  for (unsigned& i : index)
    if (i != kUnused) i = count++;
  const auto keep = [&](auto& attribute, std::size_t copies) {
    if (attribute.empty()) return;
    for (std::size_t k = 0; k < copies; ++k)
      for (std::size_t i = 0; i < vertices; ++i)
        if (index[i] != kUnused) attribute[k * count + index[i]] = attribute[k * vertices + i];
    attribute.resize(copies * count);
  };
  keep(mesh.positions, steps);
  keep(mesh.normals, steps);
  keep(mesh.uvs, 1);
  keep(mesh.colors, 1);
  for (glm::uvec3& t : mesh.triangles) t = glm::uvec3(index[t.x], index[t.y], index[t.z]);
  return dropped;
}

// In world space, with normals; nothing left out yet.
TriangleMesh placeMesh(MeshData data, const MeshOptions& options) {
  TriangleMesh mesh;
  mesh.positions = std::move(data.positions);
  mesh.normals = std::move(data.normals);
  mesh.uvs = std::move(data.uvs);
  mesh.colors = std::move(data.colors);
  mesh.triangles = std::move(data.triangles);

  const bool identity = options.toWorld == Mat4(1);
  const glm::dmat4 toWorld(options.toWorld);
  if (!identity)
    for (Vec3f& p : mesh.positions) p = Vec3f(glm::dvec3(toWorld * glm::dvec4(glm::dvec3(p), 1)));
  for (const Vec3f& p : mesh.positions)
    if (!finite(p)) throw MeshError("a vertex is not finite after the transformation");

  const auto rewind = [&] {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.x, t.y);
  };
  if (options.rewindMirrored && glm::determinant(glm::dmat3(toWorld)) < 0) rewind();

  if (options.faceNormals || data.faceNormals) {
    mesh.normals.clear();
    if (options.flipNormals) rewind();
  } else {
    std::vector<Vec3f> computed;
    if (mesh.normals.empty()) {
      mesh.normals = computeNormals(mesh.positions, mesh.triangles);
    } else {
      const glm::dmat3 transform = normalTransform(options.toWorld);
      for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::dvec3 n = transform * glm::dvec3(mesh.normals[i]);
        const double length = glm::length(n);
        if (length > 1e-20 && std::isfinite(length)) {
          mesh.normals[i] = Vec3f(n / length);
        } else {
          if (computed.empty()) computed = computeNormals(mesh.positions, mesh.triangles);
          mesh.normals[i] = computed[i];
        }
      }
    }
    if (options.flipNormals)
      for (Vec3f& n : mesh.normals) n = Vec3f(0) - n;
  }

  return mesh;
}

}  // namespace

glm::dmat3 normalTransform(const Mat4& toWorld) {
  return glm::transpose(glm::inverse(glm::dmat3(glm::dmat4(toWorld))));
}

TriangleMesh finishMesh(MeshData data, const MeshOptions& options, std::size_t& dropped) {
  TriangleMesh mesh = placeMesh(std::move(data), options);
  dropped = compact(mesh, 1);
  return mesh;
}

MovingMesh joinSteps(std::vector<TriangleMesh> steps) {
  MovingMesh mesh;
  mesh.segments = static_cast<int>(steps.size()) - 1;
  mesh.triangles = std::move(steps[0].triangles);
  mesh.uvs = std::move(steps[0].uvs);
  mesh.colors = std::move(steps[0].colors);
  mesh.parallelogram = steps[0].parallelogram;
  for (const TriangleMesh& step : steps) {
    mesh.positions.insert(mesh.positions.end(), step.positions.begin(), step.positions.end());
    mesh.normals.insert(mesh.normals.end(), step.normals.begin(), step.normals.end());
  }
  return mesh;
}

MovingMesh finishMovingMesh(const MeshData& data, const MeshOptions& options,
                            std::span<const Mat4> toWorld, std::size_t& dropped) {
  std::vector<TriangleMesh> steps;
  for (const Mat4& matrix : toWorld) {
    MeshOptions own = options;
    own.toWorld = matrix;
    steps.push_back(placeMesh(data, own));
  }
  MovingMesh mesh = joinSteps(std::move(steps));
  dropped = compact(mesh, toWorld.size());
  return mesh;
}

}  // namespace h2mc
