// SPDX-License-Identifier: MIT
// Meshes of every format, whole and broken.
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstring>

#include "render/geometry/mesh_data.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

template <class Load>
std::string errorOf(Load load) {
  try {
    load();
  } catch (const MeshError& e) {
    return e.what();
  }
  return "";
}

::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << part << "\" is not in \"" << text << "\"";
}

MeshData obj(const std::string& text, bool flip = false) {
  const SceneFolder folder;
  return loadObj(folder.write("a.obj", text), flip);
}
std::string objError(const std::string& text) {
  return errorOf([&] { obj(text); });
}

TEST(MeshObj, TrianglesQuadsAndPolygons) {
  const MeshData m =
      obj("# a comment\r\nmtllib a.mtl\r\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nv -1 .5 0\n"
          "usemtl red\ns 1\nf 1 2 3\nf 1 2 3 4 # quad\nf 1 2 3 4 5\nl 1 2\n");
  EXPECT_EQ(m.triangles.size(), 6u);
  EXPECT_EQ(m.positions.size(), 5u);
  EXPECT_TRUE(m.normals.empty());
  EXPECT_TRUE(m.uvs.empty());
  EXPECT_EQ(m.triangles[2], glm::uvec3(0, 2, 3));
}

TEST(MeshObj, IndicesOfAllForms) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0\nvt 0 1\nvn 0 0 1\n";
  const MeshData full = obj(head + "f 1/1/1 2/2/1 3/3/1\n");
  EXPECT_EQ(full.normals.size(), 3u);
  ASSERT_EQ(full.uvs.size(), 3u);
  EXPECT_FLOAT_EQ(full.uvs[0].y, 0.25f);
  EXPECT_FLOAT_EQ(obj(head + "f 1/1/1 2/2/1 3/3/1\n", true).uvs[0].y, 0.75f);
  EXPECT_TRUE(obj(head + "f 1//1 2//1 3//1\n").uvs.empty());
  EXPECT_TRUE(obj(head + "f 1/1 2/2 3/3\n").normals.empty());
  const MeshData negative = obj(head + "f -3/-3/-1 -2/-2/-1 -1/-1/-1\n");
  EXPECT_EQ(negative.positions[0], full.positions[0]);
  EXPECT_EQ(negative.uvs[2], full.uvs[2]);
}

TEST(MeshObj, VerticesAreSharedByValueWithinAGroup) {
  // Two triangles that repeat their corners: one smooth surface, but not across groups.
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(obj(corners + "f 4 5 6\n").positions.size(), 4u);
  EXPECT_EQ(obj(corners + "g other\nf 4 5 6\n").positions.size(), 6u);
}

TEST(MeshObj, Mistakes) {
  EXPECT_TRUE(contains(objError("v 0 0 0\n"), "a.obj:1: the mesh has no faces"));
  EXPECT_TRUE(contains(objError(""), "the file is empty"));
  EXPECT_TRUE(contains(objError("v 0 0\n"), "a.obj:1: a number is missing"));
  EXPECT_TRUE(contains(objError("v 0 0 0\nv 0 0 x\n"), "a.obj:2: \"x\" is not a finite number"));
  EXPECT_TRUE(contains(objError("v 0 0 nan\n"), "not a finite number"));
  EXPECT_TRUE(contains(objError("v 0 0 1e60\n"), "not a finite number"));
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_TRUE(contains(objError(v + "f 1 2 4\n"), "vertex 4 is out of range: there are 3"));
  EXPECT_TRUE(contains(objError(v + "f 1 2 0\n"), "vertex 0 is out of range"));
  EXPECT_TRUE(contains(objError(v + "f 1 2 -4\n"), "vertex -4 is out of range"));
  EXPECT_TRUE(contains(objError(v + "f 1/1 2/1 3/1\n"), "texture coordinate 1 is out of range"));
  EXPECT_TRUE(contains(objError(v + "f 1 2\n"), "a face with 2 corners"));
  EXPECT_TRUE(contains(objError(v + "f 1 2 3x\n"), "is not an integer"));
  EXPECT_TRUE(contains(errorOf([] { loadObj("/no/such.obj", true); }), "no such file"));
}

// --- PLY

std::string plyHeader(const std::string& format, const std::string& vertex,
                      const std::string& faceType = "int", int vertices = 4) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(vertices) + "\n" + vertex + "element face 1\nproperty list uchar " +
         faceType + " vertex_indices\nend_header\n";
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

MeshData ply(const std::string& text) {
  const SceneFolder folder;
  return loadPly(folder.write("a.ply", text), false);
}
std::string plyError(const std::string& text) {
  return errorOf([&] { ply(text); });
}

template <class Value>
void append(std::string& out, Value value, bool big) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (big == (std::endian::native == std::endian::little))
    std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

void expectSquare(const MeshData& m) {
  ASSERT_EQ(m.positions.size(), 4u);
  ASSERT_EQ(m.triangles.size(), 2u);
  EXPECT_EQ(m.positions[2], Vec3f(1, 1, 0.5f));
  EXPECT_EQ(m.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(m.triangles[1], glm::uvec3(0, 2, 3));
}

TEST(MeshPly, Ascii) {
  const MeshData m =
      ply(plyHeader("ascii", kXyz + "property float nx\nproperty float ny\n"
                                    "property float nz\nproperty float s\nproperty float t\n"
                                    "property uchar red\n") +
          "0 0 .5 0 0 1 0 0 255\n1 0 .5 0 0 1 1 0 255\n1 1 .5 0 0 1 1 1 255\n"
          "0 1 .5 0 0 1 0 1 255\n4 0 1 2 3\n");
  expectSquare(m);
  ASSERT_EQ(m.normals.size(), 4u);
  EXPECT_EQ(m.normals[3], Vec3f(0, 0, 1));
  ASSERT_EQ(m.uvs.size(), 4u);
  EXPECT_EQ(m.uvs[1], Vec2f(1, 0));
}

TEST(MeshPly, BinaryOfBothByteOrdersAndPrecisions) {
  const float corners[4][3] = {{0, 0, .5f}, {1, 0, .5f}, {1, 1, .5f}, {0, 1, .5f}};
  for (bool big : {false, true}) {
    for (bool isDouble : {false, true}) {
      const std::string number = isDouble ? "double" : "float";
      std::string text = plyHeader(big ? "binary_big_endian" : "binary_little_endian",
                                   "property uchar quality\nproperty " + number + " x\nproperty " +
                                       number + " y\nproperty " + number + " z\n",
                                   "ushort");
      for (const auto& corner : corners) {
        append<std::uint8_t>(text, 7, big);
        for (float x : corner) {
          if (isDouble)
            append<double>(text, static_cast<double>(x), big);
          else
            append<float>(text, x, big);
        }
      }
      append<std::uint8_t>(text, 4, big);
      for (std::uint16_t i = 0; i < 4; ++i) append(text, i, big);
      expectSquare(ply(text));
      EXPECT_TRUE(contains(plyError(text.substr(0, text.size() - 1)), "the file ends early"));
    }
  }
}

// Two strips in one list: a square, and a triangle by itself. All wind the same way.
TEST(MeshPly, TriangleStrips) {
  const MeshData m =
      ply("ply\nformat ascii 1.0\nelement vertex 7\n" + kXyz +
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 0\n5 0 0\n4 1 0\n9 0 1 2 3 -1 4 5 6 -1\n");
  ASSERT_EQ(m.triangles.size(), 3u);
  for (const glm::uvec3& t : m.triangles) {
    const Vec3f n = cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]);
    EXPECT_EQ(n, Vec3f(0, 0, 1));
  }
  EXPECT_EQ(m.triangles[1], glm::uvec3(2, 1, 3));
  EXPECT_TRUE(
      contains(plyError("ply\nformat ascii 1.0\nelement vertex 3\n" + kXyz +
                        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                        "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"),
               "strip 0 has a bad vertex"));
}

TEST(MeshPly, Mistakes) {
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_TRUE(contains(plyError("plyx\n"), "not a PLY file"));
  EXPECT_TRUE(contains(plyError("ply\nformat ascii 1.0\n"), "the header has no end"));
  EXPECT_TRUE(contains(plyError("ply\nformat utf8 1.0\n"), "a.ply:2: unknown format \"utf8\""));
  EXPECT_TRUE(contains(plyError("ply\nend_header\n"), "names no format"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", "property half x\n") + square),
                       "unknown type \"half\""));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", "property float x\n") + square), "no x, y, z"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz) + square + "4 0 1 2 4\n"),
                       "vertex 4 of a face is out of range: there are 4"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz) + square + "3 0 1 -1\n"), "bad vertex"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz) + square + "2 0 1\n"), "fewer than 3"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz) + square + "200 0 1\n"), "ends early"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz) + square), "too short"));
  EXPECT_TRUE(
      contains(plyError(plyHeader("ascii", kXyz) + "0 0 0\n1 0 nan\n" + square), "not a finite"));
  EXPECT_TRUE(contains(plyError(plyHeader("ascii", kXyz, "int", 2000000000)), "too short"));
  std::string nan = plyHeader("binary_little_endian", kXyz, "int", 1);
  for (int i = 0; i < 3; ++i) append<std::uint32_t>(nan, 0x7fc00000u, false);
  EXPECT_TRUE(contains(plyError(nan), "\"x\" of vertex 0 is not a finite number"));
}

// --- serialized

struct SerializedMesh {
  bool isDouble = false, faceNormals = false;
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<float, 2>> uvs;
  bool colors = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

SerializedMesh serializedTriangle() {
  SerializedMesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}};
  return m;
}

std::string encode(const SerializedMesh& mesh, int version) {
  std::string raw;
  append<std::uint32_t>(raw,
                        (mesh.normals.empty() ? 0u : 1u) | (mesh.uvs.empty() ? 0u : 2u) |
                            (mesh.colors ? 8u : 0u) | (mesh.faceNormals ? 0x10u : 0u) |
                            (mesh.isDouble ? 0x2000u : 0x1000u),
                        false);
  if (version == 4) raw += std::string("a name") + '\0';
  append<std::uint64_t>(raw, mesh.positions.size(), false);
  append<std::uint64_t>(raw, mesh.triangles.size(), false);
  const auto number = [&](float x) {
    if (mesh.isDouble)
      append<double>(raw, static_cast<double>(x), false);
    else
      append<float>(raw, x, false);
  };
  for (const auto& p : mesh.positions)
    for (float x : p) number(x);
  for (const auto& n : mesh.normals)
    for (float x : n) number(x);
  for (const auto& uv : mesh.uvs)
    for (float x : uv) number(x);
  if (mesh.colors)
    for (std::size_t i = 0; i < 3 * mesh.positions.size(); ++i) number(0.5f);
  for (const auto& t : mesh.triangles)
    for (std::uint32_t i : t) append(raw, i, false);
  uLongf size = compressBound(raw.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(raw.data()), raw.size());
  packed.resize(size);
  std::string out;
  append<std::uint16_t>(out, 0x041C, false);
  append<std::uint16_t>(out, static_cast<std::uint16_t>(version), false);
  return out + packed;
}

std::string encodeFile(const std::vector<SerializedMesh>& meshes, int version) {
  std::string out, table;
  for (const SerializedMesh& mesh : meshes) {
    if (version == 4)
      append<std::uint64_t>(table, out.size(), false);
    else
      append<std::uint32_t>(table, static_cast<std::uint32_t>(out.size()), false);
    out += encode(mesh, version);
  }
  append<std::uint32_t>(table, static_cast<std::uint32_t>(meshes.size()), false);
  return out + table;
}

MeshData serialized(const std::string& bytes, int index = 0) {
  const SceneFolder folder;
  return loadSerialized(folder.write("a.serialized", bytes), index);
}
std::string serializedError(const std::string& bytes, int index = 0) {
  return errorOf([&] { serialized(bytes, index); });
}

TEST(MeshSerialized, BothVersionsAndPrecisions) {
  for (int version : {3, 4}) {
    for (bool isDouble : {false, true}) {
      SerializedMesh first = serializedTriangle(), second = serializedTriangle();
      first.isDouble = second.isDouble = isDouble;
      second.positions[2] = {0, 2, 0};
      second.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
      second.uvs = {{0, 0}, {1, 0}, {0, 1}};
      second.colors = second.faceNormals = true;
      const std::string file = encodeFile({first, second, first}, version);
      const MeshData a = serialized(file, 0), b = serialized(file, 1), c = serialized(file, 2);
      EXPECT_EQ(a.positions[2], Vec3f(0, 1, 0));
      EXPECT_TRUE(a.normals.empty());
      EXPECT_TRUE(a.uvs.empty());
      EXPECT_FALSE(a.faceNormals);
      EXPECT_EQ(b.positions[2], Vec3f(0, 2, 0));
      EXPECT_EQ(b.normals[1], Vec3f(0, 0, 1));
      EXPECT_EQ(b.uvs[1], Vec2f(1, 0));
      EXPECT_TRUE(b.faceNormals);
      EXPECT_EQ(b.triangles[0], glm::uvec3(0, 1, 2));
      EXPECT_EQ(c.positions[2], Vec3f(0, 1, 0));
    }
  }
}

TEST(MeshSerialized, Mistakes) {
  const std::string file = encodeFile({serializedTriangle()}, 4);
  EXPECT_TRUE(contains(serializedError(file, 1), "there is no mesh 1, the file has 0 to 0"));
  EXPECT_TRUE(contains(serializedError("obj?????"), "not a file of serialized meshes"));
  std::string version = file;
  version[2] = 9;
  EXPECT_TRUE(contains(serializedError(version), "version 9 is not supported"));
  SerializedMesh bad = serializedTriangle();
  bad.triangles[0][1] = 3;
  EXPECT_TRUE(contains(serializedError(encodeFile({bad}, 4)),
                       "vertex 3 of triangle 0 is out of range, there are 3"));
  bad = serializedTriangle();
  bad.positions[1][2] = NAN;
  EXPECT_TRUE(contains(serializedError(encodeFile({bad}, 4)), "vertex 1 is not finite"));
  bad.positions.clear();
  EXPECT_TRUE(contains(serializedError(encodeFile({bad}, 4)), "the mesh has no triangles"));
}

TEST(MeshSerialized, DamagedFilesAreRefusedOrRead) {
  const std::string file = encodeFile({serializedTriangle(), serializedTriangle()}, 4);
  for (std::size_t length = 0; length < file.size(); ++length)
    EXPECT_FALSE(serializedError(file.substr(0, length), 1).empty()) << length;
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (int bit = 0; bit < 8; bit += 3) {
      std::string damaged = file;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      errorOf([&] { serialized(damaged, 0); });  // no crash, nothing but MeshError
    }
  }
}

}  // namespace
}  // namespace h2mc::testing
