// SPDX-License-Identifier: MIT
// A mesh as the templated code reads it: at rest, or at a moment of its motion.
#pragma once

#include "render/geometry/moment.h"
#include "render/geometry/shape.h"

namespace h2mc::detail {

// Corners and normals are scene data: plain numbers of the scalar S.
template <class S>
struct StillMesh {
  using P = S;
  const TriangleMesh& mesh;

  const glm::uvec3& triangle(std::uint32_t index) const { return mesh.triangles[index]; }
  Vec3<S> position(unsigned i) const { return Vec3<S>(mesh.positions[i]); }
  glm::dvec3 exactPosition(unsigned i) const { return glm::dvec3(mesh.positions[i]); }
  bool hasNormals() const { return !mesh.normals.empty(); }
  bool sameNormals(const glm::uvec3& t) const {
    return mesh.normals[t.x] == mesh.normals[t.y] && mesh.normals[t.x] == mesh.normals[t.z];
  }
  Vec3<S> normal(unsigned i) const { return Vec3<S>(mesh.normals[i]); }
  bool hasUvs() const { return !mesh.uvs.empty(); }
  const Vec2f& uv(unsigned i) const { return mesh.uvs[i]; }
};

// Corners and normals are functions of the moment, of its scalar type. Normals are not of unit length.
template <class T>
struct MeshAtMoment {
  using P = T;
  const MovingMesh& mesh;
  Moment<T> moment;
  std::size_t first, second;  // where the two steps' vertices begin

  MeshAtMoment(const MovingMesh& movingMesh, const T& time)
      : mesh(movingMesh), moment(Moment<T>::at(movingMesh.segments, time)) {
    first = mesh.vertices() * static_cast<std::size_t>(moment.index);
    second = first + mesh.vertices();
  }

  const glm::uvec3& triangle(std::uint32_t index) const { return mesh.triangles[index]; }
  Vec3<T> position(unsigned i) const {
    return moment.between(mesh.positions[first + i], mesh.positions[second + i]);
  }
  glm::dvec3 exactPosition(unsigned i) const {
    return moment.exactlyBetween(mesh.positions[first + i], mesh.positions[second + i]);
  }
  bool hasNormals() const { return !mesh.normals.empty(); }
  bool sameNormals(const glm::uvec3&) const { return false; }
  Vec3<T> normal(unsigned i) const {
    return moment.between(mesh.normals[first + i], mesh.normals[second + i]);
  }
  bool hasUvs() const { return !mesh.uvs.empty(); }
  const Vec2f& uv(unsigned i) const { return mesh.uvs[i]; }
};

}  // namespace h2mc::detail
