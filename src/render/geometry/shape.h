// SPDX-License-Identifier: MIT
// Shapes in world space. Transforms are applied when the scene is read.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "render/core/types.h"

namespace h2mc {

struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // empty, or one a vertex, unit length: shading normals
  std::vector<Vec2f> uvs;      // empty, or one a vertex
  std::vector<Rgbf> colors;    // the same, for the scene reader: textures keep what they need
  std::vector<glm::uvec3> triangles;
  // Not 0: the texture coordinates of its points are MeshPlaces in so many columns. Its tangents are those of uvs.
  std::uint32_t placeColumns = 0;
  // Two triangles that make one parallelogram (0,1,2), (2,3,0): sampled as one surface, so that
  // the map from primary coordinates to points has no seam.
  bool parallelogram = false;
};

struct Sphere {
  Vec3f center{0};
  float radius = 1;
  bool flipNormals = false;
  glm::mat3 toLocal{1};  // rotation to the frame of the texture coordinates
};

// The image of the unit disk in z = 0 under an affine map: p = center + x * axisX + y * axisY.
struct Disk {
  Vec3f center{0};
  Vec3f axisX{1, 0, 0};
  Vec3f axisY{0, 1, 0};
  Vec3f normal{0, 0, 1};  // unit, flipped already where the scene says so
};

// Open: without its two lids.
struct Cylinder {
  Vec3f start{0}, end{0, 0, 1};  // the lids' centres
  float radius = 1;
  Vec3f axisX{1, 0, 0};  // across: towards texture coordinate u = 0
  bool flipNormals = false;
};

// Shapes that move: their state at equally spaced moments of the shutter's opening, from its
// beginning to its end. Between two of these steps every number goes in a straight line (normals are
// brought to unit length afterwards): that is how Embree sees motion, so it is what motion is here.

struct MovingMesh {
  int segments = 1;              // steps - 1, at least 1
  std::vector<Vec3f> positions;  // of all vertices at the first step, then at the second, ...
  std::vector<Vec3f> normals;    // empty, or likewise
  std::vector<Vec2f> uvs;        // empty, or one a vertex
  std::vector<Rgbf> colors;      // these and placeColumns as in TriangleMesh
  std::vector<glm::uvec3> triangles;
  std::uint32_t placeColumns = 0;
  bool parallelogram = false;  // as in TriangleMesh
  std::size_t vertices() const { return positions.size() / static_cast<std::size_t>(segments + 1); }
};

struct MovingSphere {
  std::vector<Sphere> steps;  // at least 2
};

struct MovingDisk {
  std::vector<Disk> steps;  // at least 2
};

struct MovingCylinder {
  std::vector<Cylinder> steps;  // at least 2
};

// A mesh that several shapes share, in a space of its own.
struct SharedMesh {
  TriangleMesh mesh;  // never a parallelogram
  // Of all of it, where an instance is asked for what would take long to find by its vertices.
  Vec3f low{0}, high{0};
  float longestEdge = 0, medianEdge = 0;

  explicit SharedMesh(TriangleMesh triangles);
};

// Where an instance puts its mesh.
class Placement {
 public:
  // Precondition: can be inverted.
  explicit Placement(const Mat4& toWorld)
      : toWorld_(toWorld),
        normalToWorld_(glm::transpose(glm::inverse(glm::dmat3(toWorld_)))),
        mirrors_(glm::determinant(glm::dmat3(toWorld_)) < 0) {}

  glm::dvec3 point(const glm::dvec3& p) const { return glm::dvec3(toWorld_ * glm::dvec4(p, 1)); }
  // Of unit length.
  glm::dvec3 normal(const Vec3f& n) const {
    const glm::dvec3 placed = normalToWorld_ * glm::dvec3(n);
    const double length = glm::length(placed);
    return length > 0 ? placed / length : placed;
  }
  bool mirrors() const { return mirrors_; }
  const glm::dmat4& toWorld() const { return toWorld_; }

 private:
  glm::dmat4 toWorld_;
  glm::dmat3 normalToWorld_;
  bool mirrors_;
};

struct MeshInstance {
  std::shared_ptr<const SharedMesh> shared;
  Placement placement;
};

struct MovingMeshInstance {
  std::shared_ptr<const SharedMesh> shared;
  std::vector<Placement> steps;  // at least 2; all mirror, or none
};

using Geometry = std::variant<TriangleMesh, Sphere, Disk, Cylinder, MovingMesh, MovingSphere,
                              MovingDisk, MovingCylinder, MovingMeshInstance, MeshInstance>;

struct Shape {
  std::string name;  // id or plugin name with file, for messages
  Geometry geometry;
  int material = -1;  // index into Scene::materials
  int light = -1;     // index into Scene::lights of the area light on it, or -1

  // Made of triangles: an instance too.
  bool isMesh() const {
    const std::size_t i = geometry.index();
    return i == 0 || i == 4 || i >= 8;
  }
  bool isInstance() const { return geometry.index() >= 8; }
  bool moves() const { return geometry.index() >= 4 && geometry.index() != 9; }
  // Lines meet it twice: which of the two is a PrimitiveId's `primitive`.
  bool hasTwoRoots() const {
    const std::size_t i = geometry.index();
    return i == 1 || i == 3 || i == 5 || i == 7;
  }
  // Of a mesh; of anything else none.
  std::span<const glm::uvec3> triangles() const;
  bool isParallelogram() const;
  // Of an instance: its mesh, and where that is, at rest or at the steps of its motion. Else null, and none.
  const SharedMesh* sharedMesh() const;
  std::span<const Placement> placements() const;
  // Into how many pieces of equal length the shutter's opening is cut for it; 0 if it does not move.
  int motionSegments() const;
};

}  // namespace h2mc
