// SPDX-License-Identifier: MIT
#include "render/geometry/mesh_data.h"

namespace h2mc {

TriangleMesh makeRectangle(const Mat4& toWorld, bool flipNormals) {
  // The winding follows the normal, which a mirroring transform does not turn round.
  const bool mirrored = glm::determinant(glm::dmat3(glm::dmat4(toWorld))) < 0;
  const bool reversed = mirrored != flipNormals;
  const Vec2f corners[4] = {Vec2f(-1, -1), Vec2f(1, -1), Vec2f(1, 1), Vec2f(-1, 1)};
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    const Vec2f c = corners[reversed ? (4 - i) % 4 : i];
    const glm::dvec4 p = glm::dmat4(toWorld) * glm::dvec4(c.x, c.y, 0, 1);
    mesh.positions.push_back(Vec3f(glm::dvec3(p)));
    mesh.uvs.push_back(Vec2f(0.5f * (c.x + 1), 0.5f * (c.y + 1)));
  }
  mesh.triangles = {glm::uvec3(0, 1, 2), glm::uvec3(2, 3, 0)};
  mesh.parallelogram = true;
  return mesh;
}

MeshData makeCube() {
  // A corner at uv (0, 0) and the directions in which u and v grow, as in Mitsuba 0.6.
  struct Face {
    Vec3f corner, u, v;
  };
  const Face faces[6] = {
      {{-1, -1, -1}, {0, 0, 1}, {1, 0, 0}}, {{1, 1, 1}, {-1, 0, 0}, {0, 0, -1}},
      {{1, -1, 1}, {0, 1, 0}, {0, 0, -1}},  {{-1, -1, 1}, {0, 1, 0}, {1, 0, 0}},
      {{-1, -1, -1}, {0, 1, 0}, {0, 0, 1}}, {{-1, 1, -1}, {0, -1, 0}, {1, 0, 0}}};
  MeshData data;
  for (const Face& f : faces) {
    const auto first = static_cast<unsigned>(data.positions.size());
    const Vec3f normal(f.v.y * f.u.z - f.v.z * f.u.y, f.v.z * f.u.x - f.v.x * f.u.z,
                       f.v.x * f.u.y - f.v.y * f.u.x);
    for (const Vec2f& uv : {Vec2f(0, 0), Vec2f(0, 1), Vec2f(1, 1), Vec2f(1, 0)}) {
      data.positions.push_back(f.corner + f.u * (2 * uv.x) + f.v * (2 * uv.y));
      data.normals.push_back(normal);
      data.uvs.push_back(uv);
    }
    data.triangles.push_back({first, first + 1, first + 2});
    data.triangles.push_back({first + 2, first + 3, first});
  }
  return data;
}

}  // namespace h2mc
