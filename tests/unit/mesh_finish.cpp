// SPDX-License-Identifier: MIT
// From a file's mesh to a shape in world space, as Mitsuba 0.6 does it.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "render/geometry/mesh_data.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

void expectNear(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Vec3f faceNormal(const TriangleMesh& mesh, std::size_t triangle = 0) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  return Vec3f(glm::normalize(glm::cross(b - a, c - a)));
}

MeshData triangle() {
  MeshData m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}};
  return m;
}

TriangleMesh finished(MeshData data, const MeshOptions& options, std::size_t expectedDropped = 0) {
  std::size_t dropped = 99;
  TriangleMesh mesh = finishMesh(std::move(data), options, dropped);
  EXPECT_EQ(dropped, expectedDropped);
  return mesh;
}

TEST(MeshFinish, MissingNormalsAreComputedWeightedByAngle) {
  // Two faces meet at a right angle in the edge between vertices 0 and 1; at vertex 0 one has an
  // angle of 90 degrees, the other one of 45.
  MeshData data;
  data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, -1}};
  data.triangles = {{0, 1, 2}, {0, 3, 1}};
  const TriangleMesh mesh = finished(data, {});
  ASSERT_EQ(mesh.normals.size(), 4u);
  const Vec3f n0 = faceNormal(mesh, 0), n1 = faceNormal(mesh, 1);
  expectNear(n0, {0, 0, 1});
  const glm::dvec3 sum = glm::dvec3(n0) * 90.0 + glm::dvec3(n1) * 45.0;
  expectNear(mesh.normals[0], Vec3f(glm::normalize(sum)));
  expectNear(mesh.normals[2], n0);
  expectNear(mesh.normals[3], n1);
}

TEST(MeshFinish, FaceNormalsAndFlips) {
  MeshOptions options;
  options.faceNormals = true;
  EXPECT_TRUE(finished(triangle(), options).normals.empty());
  expectNear(faceNormal(finished(triangle(), options)), {0, 0, 1});
  options.flipNormals = true;
  expectNear(faceNormal(finished(triangle(), options)), {0, 0, -1});
  options.faceNormals = false;
  expectNear(finished(triangle(), options).normals[0], {0, 0, -1});

  MeshData given = triangle();
  given.normals.assign(3, Vec3f(0, 0.6f, 0.8f));
  expectNear(finished(given, {}).normals[1], {0, 0.6f, 0.8f});
  expectNear(finished(given, options).normals[1], {0, -0.6f, -0.8f});
  given.faceNormals = true;  // the file's own flag
  EXPECT_TRUE(finished(given, {}).normals.empty());
}

TEST(MeshFinish, NormalsTransformByTheInverseTranspose) {
  MeshData data = triangle();
  data.normals.assign(3, Vec3f(0, 1 / std::sqrt(2.f), 1 / std::sqrt(2.f)));
  MeshOptions options;
  options.toWorld = glm::scale(glm::translate(Mat4(1), glm::vec3(1, 2, 3)), glm::vec3(1, 1, 3));
  const TriangleMesh mesh = finished(data, options);
  expectNear(mesh.positions[1], {2, 2, 3});
  expectNear(mesh.normals[0], Vec3f(glm::normalize(glm::dvec3(0, 1, 1 / 3.0))));
}

TEST(MeshFinish, MirroredMeshes) {
  MeshOptions options;
  options.toWorld = glm::scale(Mat4(1), glm::vec3(-1, 1, 1));
  options.faceNormals = true;
  expectNear(faceNormal(finished(triangle(), options)), {0, 0, -1});  // obj, ply: winding turns
  options.rewindMirrored = true;
  expectNear(faceNormal(finished(triangle(), options)), {0, 0, 1});  // serialized: it does not
}

TEST(MeshFinish, MissingAndZeroNormalsOfSomeVertices) {
  MeshData data = triangle();
  data.normals = {Vec3f(0, 1, 0), Vec3f(0), Vec3f(0, 1, 0)};
  const TriangleMesh mesh = finished(data, {});
  expectNear(mesh.normals[0], {0, 1, 0});
  expectNear(mesh.normals[1], {0, 0, 1});
}

TEST(MeshFinish, DropsWhatHasNoArea) {
  MeshData data = triangle();
  data.positions.push_back({2, 0, 0});
  data.positions.push_back({5, 5, 5});
  data.triangles = {{0, 1, 3}, {0, 1, 2}, {1, 1, 2}};
  const TriangleMesh mesh = finished(data, {}, 2);
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions.size(), 3u);  // and the vertices that are not used
  data.triangles = {{0, 1, 3}};
  EXPECT_TRUE(finished(data, {}, 1).triangles.empty());
}

TEST(MeshFinish, OverflowIsAnError) {
  MeshOptions options;
  options.toWorld = glm::scale(Mat4(1), glm::vec3(3e38f));
  MeshData data = triangle();
  data.positions[1].x = 1e10f;
  std::size_t dropped;
  EXPECT_THROW(finishMesh(data, options, dropped), MeshError);
}

TEST(MeshPrimitives, Rectangle) {
  for (bool flip : {false, true}) {
    for (float mirror : {1.f, -1.f}) {
      const Mat4 m = glm::scale(Mat4(1), glm::vec3(mirror * 2, 1, 1));
      const TriangleMesh mesh = makeRectangle(m, flip);
      EXPECT_TRUE(mesh.parallelogram);
      ASSERT_EQ(mesh.triangles.size(), 2u);
      EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 2));
      EXPECT_EQ(mesh.triangles[1], glm::uvec3(2, 3, 0));
      // Mirroring does not turn the normal, flipping does.
      expectNear(faceNormal(mesh, 0), {0, 0, flip ? -1.f : 1.f});
      expectNear(faceNormal(mesh, 1), {0, 0, flip ? -1.f : 1.f});
      expectNear(mesh.positions[0] + mesh.positions[2], mesh.positions[1] + mesh.positions[3]);
      for (std::size_t i = 0; i < 4; ++i) {  // uv follows the object's x and y
        EXPECT_FLOAT_EQ(mesh.positions[i].x / (2 * mirror), 2 * mesh.uvs[i].x - 1);
        EXPECT_FLOAT_EQ(mesh.positions[i].y, 2 * mesh.uvs[i].y - 1);
      }
    }
  }
}

TEST(MeshPrimitives, CubeFacesOutwards) {
  const MeshData data = makeCube();
  EXPECT_EQ(data.triangles.size(), 12u);
  EXPECT_EQ(data.positions.size(), 24u);
  const TriangleMesh mesh = finished(data, {});
  for (std::size_t i = 0; i < 12; ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const Vec3f n = faceNormal(mesh, i);
    EXPECT_NEAR(dot(n, mesh.positions[t.x]), 1, 1e-6f);
    for (int k = 0; k < 3; ++k) {
      expectNear(mesh.normals[t[k]], n);
      EXPECT_NEAR(std::fabs(mesh.positions[t[k]].x), 1, 1e-6f);
    }
  }
}

TEST(MeshInScenes, BrokenMeshesAreOneMessageAtTheFilesName) {
  const SceneFolder folder;
  folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
  const std::string message = folder.error(
      sceneWith("<shape type=\"obj\"><string name=\"filename\" value=\"bad.obj\"/></shape>"));
  EXPECT_NE(message.find("scene.xml:2:50: error: shape \"obj\": broken mesh: bad.obj:2: vertex 2"),
            std::string::npos)
      << message;
}

TEST(MeshInScenes, ShapesArriveInWorldSpace) {
  const SceneFolder folder;
  const std::string move =
      "<transform name=\"toWorld\"><scale value=\"2\"/><rotate x=\"1\" "
      "angle=\"-90\"/><translate y=\"5\"/></transform>";
  const Scene scene = folder.read(sceneWith(
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"1\"/>" + move +
      "</shape>" + "<shape type=\"disk\">" + move + "</shape><shape type=\"cube\">" + move +
      "</shape>" + "<shape type=\"rectangle\"><boolean name=\"flipNormals\" value=\"true\"/>" +
      move + "</shape>"));
  const auto& sphere = std::get<Sphere>(scene.shapes[0].geometry);
  expectNear(sphere.center, {0, 7, 0});
  EXPECT_NEAR(sphere.radius, 2, 1e-5f);
  const auto& disk = std::get<Disk>(scene.shapes[1].geometry);
  expectNear(disk.center, {0, 5, 0});
  expectNear(disk.normal, {0, 1, 0});
  expectNear(disk.axisX, {2, 0, 0});
  expectNear(disk.axisY, {0, 0, -2});
  const auto& rectangle = std::get<TriangleMesh>(scene.shapes[3].geometry);
  expectNear(faceNormal(rectangle), {0, -1, 0});
}

TEST(MeshInScenes, ShapesWithoutAreaAreLeftOutAndNamed) {
  const SceneFolder folder;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  const Scene scene = folder.read(
      sceneWith("<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/></shape>"));
  EXPECT_EQ(scene.shapes.size(), 1u);
  ASSERT_GE(scene.notes.size(), 2u);
  EXPECT_NE(scene.notes[0].find("1 triangle without area"), std::string::npos) << scene.notes[0];
}

}  // namespace
}  // namespace h2mc::testing
