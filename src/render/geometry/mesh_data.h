// SPDX-License-Identifier: MIT
// Meshes as files hold them, and what makes shapes of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/core/user_error.h"
#include "render/geometry/shape.h"

namespace h2mc {

// A file that is not a mesh, or a broken one; what() names file and place and says why.
class MeshError : public UserError {
 public:
  using UserError::UserError;
};

// In object space. Every index is within range and every number finite once a loader returns it.
struct MeshData {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // empty, or one a vertex; zero where the file has none
  std::vector<Vec2f> uvs;      // empty, or one a vertex
  std::vector<Rgbf> colors;    // empty, or one a vertex; integers divided by their largest
  bool integerColors = false;  // the file has them as integers
  std::vector<glm::uvec3> triangles;
  bool faceNormals = false;  // the file asks for flat shading
  // What the file calls its materials ("" where it names none), and for each triangle which of them it has:
  // both empty where all have one.
  std::vector<std::string> materialNames;
  std::vector<std::uint32_t> materials;
};

// The triangles of each material, in the order of their names, with the vertices that they use.
std::vector<MeshData> splitByMaterial(const MeshData& data);

// The loaders. Throw MeshError; a mesh without triangles is an error too.
MeshData loadObj(const std::string& path, bool flipTexCoords);
MeshData loadPly(const std::string& path, bool flipTexCoords);
MeshData loadSerialized(const std::string& path, int shapeIndex);

struct MeshOptions {
  Mat4 toWorld{1};
  bool faceNormals = false;
  bool flipNormals = false;
  // Mitsuba 0.6 turns the winding of mirrored `serialized` meshes, and of no others.
  bool rewindMirrored = false;
};

// The mesh in world space. Vertex normals that are missing are computed, weighted by angle, unless
// the mesh is to be flat. Triangles without area are dropped and counted; the result may be empty.
// Throws MeshError when the transformed numbers are not finite.
TriangleMesh finishMesh(MeshData data, const MeshOptions& options, std::size_t& dropped);

// One mesh of several states of the same triangles at equally spaced moments, at least 2. All but positions and normals
// are the first's. Precondition: as many vertices and normals in all.
MovingMesh joinSteps(std::vector<TriangleMesh> steps);

// As finishMesh, with a transform for each of the equally spaced moments instead of options.toWorld.
// Triangles are dropped that have no area at any of them. Precondition: at least 2.
MovingMesh finishMovingMesh(const MeshData& data, const MeshOptions& options,
                            std::span<const Mat4> toWorld, std::size_t& dropped);

// The square [-1, 1]^2 in z = 0 with its normal along +z.
TriangleMesh makeRectangle(const Mat4& toWorld, bool flipNormals);
// The cube [-1, 1]^3 with its normals outwards and every face over all of the texture.
MeshData makeCube();

// The inverse transpose of the linear part, for normals.
glm::dmat3 normalTransform(const Mat4& toWorld);

}  // namespace h2mc
