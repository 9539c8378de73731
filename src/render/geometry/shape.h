// SPDX-License-Identifier: MIT
// Shapes in world space. Transforms are applied when the scene is read.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "render/core/types.h"

namespace h2mc {

struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // empty, or one a vertex, unit length: shading normals
  std::vector<Vec2f> uvs;      // empty, or one a vertex
  std::vector<glm::uvec3> triangles;
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
  std::vector<glm::uvec3> triangles;
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

using Geometry = std::variant<TriangleMesh, Sphere, Disk, Cylinder, MovingMesh, MovingSphere,
                              MovingDisk, MovingCylinder>;

struct Shape {
  std::string name;  // id or plugin name with file, for messages
  Geometry geometry;
  int material = -1;  // index into Scene::materials
  int light = -1;     // index into Scene::lights of the area light on it, or -1

  bool isMesh() const { return geometry.index() == 0 || geometry.index() == 4; }
  bool moves() const { return geometry.index() >= 4; }
  // Lines meet it twice: which of the two is a PrimitiveId's `primitive`.
  bool hasTwoRoots() const {
    const std::size_t i = geometry.index();
    return i == 1 || i == 3 || i == 5 || i == 7;
  }
  // Into how many pieces of equal length the shutter's opening is cut for it; 0 if it does not move.
  int motionSegments() const;
};

}  // namespace h2mc
