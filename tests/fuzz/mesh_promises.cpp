// SPDX-License-Identifier: MIT
#include "mesh_promises.h"

#include <cmath>

#include "fuzz_target.h"

namespace h2mc::fuzz {
namespace {

template <class Vector>
void requireFinite(const std::vector<Vector>& vectors, const char* what) {
  for (const Vector& v : vectors)
    for (int i = 0; i < v.length(); ++i)
      if (!std::isfinite(v[i])) throw Finding(std::string(what) + ": not finite");
}

void require(bool holds, const char* what) {
  if (!holds) throw Finding(what);
}

void requireSound(const MeshData& data) {
  const std::size_t vertices = data.positions.size();
  require(!data.triangles.empty(), "a mesh without triangles");
  require(data.normals.empty() || data.normals.size() == vertices, "normals: not one a vertex");
  require(data.uvs.empty() || data.uvs.size() == vertices, "uvs: not one a vertex");
  require(data.colors.empty() || data.colors.size() == vertices, "colors: not one a vertex");
  requireFinite(data.colors, "colors");
  requireFinite(data.positions, "positions");
  requireFinite(data.normals, "normals");
  requireFinite(data.uvs, "uvs");
  for (const glm::uvec3& t : data.triangles)
    require(t.x < vertices && t.y < vertices && t.z < vertices, "a vertex out of range");
  require(data.materials.empty() || data.materials.size() == data.triangles.size(),
          "materials: not one a triangle");
  for (const std::uint32_t material : data.materials)
    require(material < data.materialNames.size(), "a material out of range");
}

}  // namespace

void checkMesh(const MeshData& data) {
  requireSound(data);
  if (!data.materialNames.empty()) {
    std::size_t triangles = 0;
    for (const MeshData& part : splitByMaterial(data)) {
      if (part.triangles.empty()) continue;
      requireSound(part);
      triangles += part.triangles.size();
    }
    require(triangles == data.triangles.size(), "triangles lost between materials");
  }
  MeshOptions options;
  options.toWorld = Mat4(2);  // homogeneous: of no effect but on what is at float's border
  options.faceNormals = data.faceNormals;
  std::size_t dropped = 0;
  const TriangleMesh mesh = finishMesh(data, options, dropped);
  require(mesh.triangles.size() + dropped == data.triangles.size(), "triangles lost");
  requireFinite(mesh.positions, "finished positions");
  requireFinite(mesh.normals, "finished normals");
}

}  // namespace h2mc::fuzz
