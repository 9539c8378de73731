// SPDX-License-Identifier: MIT
// A mesh as the templated code reads it: at rest, or at a moment of its motion. One that is placed (an instance) is
// moved vertex by vertex as it is read.
#pragma once

#include "render/geometry/moment.h"
#include "render/geometry/shape.h"

namespace h2mc::detail {

// The corners in an order that keeps the side of the normal.
inline glm::uvec3 ordered(const glm::uvec3& t, const Placement* placement) {
  return placement && placement->mirrors() ? glm::uvec3(t.x, t.z, t.y) : t;
}

// Corners and normals are scene data: plain numbers of the scalar S.
template <class S>
struct StillMesh {
  using P = S;
  const TriangleMesh& mesh;
  const Placement* placement = nullptr;

  explicit StillMesh(const TriangleMesh& still) : mesh(still) {}
  explicit StillMesh(const MeshInstance& instance)
      : mesh(instance.shared->mesh), placement(&instance.placement) {}

  glm::uvec3 triangle(std::uint32_t index) const {
    if (placement) [[unlikely]]
      return ordered(mesh.triangles[index], placement);
    return mesh.triangles[index];
  }
  Vec3<S> position(unsigned i) const {
    if (placement) [[unlikely]]
      return Vec3<S>(exactPosition(i));
    return Vec3<S>(mesh.positions[i]);
  }
  glm::dvec3 exactPosition(unsigned i) const {
    const glm::dvec3 p(mesh.positions[i]);
    if (placement) [[unlikely]]
      return placement->point(p);
    return p;
  }
  bool hasNormals() const { return !mesh.normals.empty(); }
  bool sameNormals(const glm::uvec3& t) const {
    return mesh.normals[t.x] == mesh.normals[t.y] && mesh.normals[t.x] == mesh.normals[t.z];
  }
  Vec3<S> normal(unsigned i) const {
    if (placement) [[unlikely]]
      return Vec3<S>(placement->normal(mesh.normals[i]));
    return Vec3<S>(mesh.normals[i]);
  }
  bool hasUvs() const { return !mesh.uvs.empty(); }
  const Vec2f& uv(unsigned i) const { return mesh.uvs[i]; }
  std::uint32_t placeColumns() const { return mesh.placeColumns; }
  bool mirrored() const { return placement && placement->mirrors(); }
  bool parallelogram() const { return mesh.parallelogram && !placement; }
};

// Corners and normals are functions of the moment, of its scalar type. Normals are not of unit length.
template <class T>
class MeshAtMoment {
 public:
  using P = T;

  MeshAtMoment(const MovingMesh& mesh, const T& time)
      : moment_(Moment<T>::at(mesh.segments, time)),
        triangles_(mesh.triangles.data()),
        uvs_(mesh.uvs.data()),
        placeColumns_(mesh.placeColumns),
        parallelogram_(mesh.parallelogram) {
    const std::size_t first = mesh.vertices() * static_cast<std::size_t>(moment_.index);
    setSteps(mesh, first, first + mesh.vertices());
  }
  MeshAtMoment(const MovingMeshInstance& instance, const T& time)
      : moment_(Moment<T>::at(static_cast<int>(instance.steps.size()) - 1, time)),
        triangles_(instance.shared->mesh.triangles.data()),
        uvs_(instance.shared->mesh.uvs.data()),
        placeColumns_(instance.shared->mesh.placeColumns),
        from_(&instance.steps[static_cast<std::size_t>(moment_.index)]),
        to_(from_ + 1) {
    setSteps(instance.shared->mesh, 0, 0);
  }

  glm::uvec3 triangle(std::uint32_t index) const { return ordered(triangles_[index], from_); }
  Vec3<T> position(unsigned i) const {
    if (from_) return moment_.between(placed(*from_, i), placed(*to_, i));
    return moment_.between(first_[i], second_[i]);
  }
  glm::dvec3 exactPosition(unsigned i) const {
    if (from_) return moment_.exactlyBetween(placed(*from_, i), placed(*to_, i));
    return moment_.exactlyBetween(first_[i], second_[i]);
  }
  bool hasNormals() const { return firstNormals_; }
  bool sameNormals(const glm::uvec3&) const { return false; }
  Vec3<T> normal(unsigned i) const {
    if (from_)
      return moment_.between(Vec3f(from_->normal(firstNormals_[i])),
                             Vec3f(to_->normal(firstNormals_[i])));
    return moment_.between(firstNormals_[i], secondNormals_[i]);
  }
  bool hasUvs() const { return uvs_; }
  const Vec2f& uv(unsigned i) const { return uvs_[i]; }
  std::uint32_t placeColumns() const { return placeColumns_; }
  bool mirrored() const { return from_ && from_->mirrors(); }
  bool parallelogram() const { return parallelogram_; }

 private:
  template <class Mesh>
  void setSteps(const Mesh& mesh, std::size_t first, std::size_t second) {
    first_ = mesh.positions.data() + first;
    second_ = mesh.positions.data() + second;
    if (mesh.normals.empty()) return;
    firstNormals_ = mesh.normals.data() + first;
    secondNormals_ = mesh.normals.data() + second;
  }
  Vec3f placed(const Placement& placement, unsigned i) const {
    return Vec3f(placement.point(glm::dvec3(first_[i])));
  }

  Moment<T> moment_;
  const glm::uvec3* triangles_;
  const Vec2f* uvs_;  // null where it has none, as the normals
  std::uint32_t placeColumns_ = 0;
  bool parallelogram_ = false;
  const Vec3f *first_ = nullptr, *second_ = nullptr;  // the two steps' vertices
  const Vec3f *firstNormals_ = nullptr, *secondNormals_ = nullptr;
  const Placement *from_ = nullptr, *to_ = nullptr;  // of an instance at the two steps
};

}  // namespace h2mc::detail
