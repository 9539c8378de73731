// SPDX-License-Identifier: MIT
// Wavefront OBJ: faces of any number of corners; groups are one mesh.
#include <algorithm>
#include <array>
#include <cstring>
#include <unordered_map>

#include "render/core/input_file.h"
#include "render/core/memory.h"
#include "render/geometry/mesh_data.h"
#include "render/geometry/mesh_polygon.h"
#include "render/geometry/mesh_text.h"

namespace h2mc {
namespace {

// A vertex of the mesh is what shares position, normal, texture coordinates and group. Values are
// compared, not indices, as Mitsuba 0.6 does: it decides which faces computed normals are smoothed
// over.
struct Key {
  std::array<float, 8> values;
  unsigned group, given;  // given: bit 0 uv, bit 1 normal
  bool operator==(const Key& other) const {
    return values == other.values && group == other.group && given == other.given;
  }
};

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t h = key.group * 4ull + key.given;
    for (float f : key.values) {
      if (f == 0) f = 0;  // -0 equals 0
      std::uint32_t bits;
      std::memcpy(&bits, &f, sizeof bits);
      h = (h ^ bits) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view text, bool flip)
      : text_(path, text, true), flip_(flip) {}

  MeshData read() {
    readVertices();
    readFaces();
    if (data_.triangles.empty()) text_.fail("the mesh has no faces");
    if (!anyNormal_) data_.normals.clear();
    if (!anyUv_) data_.uvs.clear();
    if (data_.materialNames.size() < 2) data_.materials.clear();
    return std::move(data_);
  }

 private:
  // First, since faces may come before the vertices that they name.
  void readVertices() {
    while (text_.nextLine()) {
      const std::string_view keyword = text_.word();
      if (keyword == "v") {
        const float x = text_.number(), y = text_.number(), z = text_.number();
        positions_.emplace_back(x, y, z);
      } else if (keyword == "vt") {
        const float u = text_.number();
        const std::string_view second = text_.word();
        const float v = second.empty() ? 0 : text_.toNumber(second);
        uvs_.emplace_back(u, flip_ ? 1 - v : v);
      } else if (keyword == "vn") {
        const float x = text_.number(), y = text_.number(), z = text_.number();
        normals_.emplace_back(x, y, z);
      }
    }
    text_.rewind();
  }

  void readFaces() {
    while (text_.nextLine()) {
      const std::string_view keyword = text_.word();
      if (keyword == "v") {
        ++before_.positions;
      } else if (keyword == "vt") {
        ++before_.uvs;
      } else if (keyword == "vn") {
        ++before_.normals;
      } else if (keyword == "f") {
        readFace();
      } else if (keyword == "g" || keyword == "o") {
        ++group_;
      } else if (keyword == "usemtl") {
        ++group_;
        useMaterial(std::string(text_.word()));
      }
    }
  }

  // An index of the file, from 1 or from the last of those `before` the face if negative, as one from 0.
  std::size_t index(std::string_view word, std::size_t count, std::size_t before,
                    const char* what) const {
    const long long written = text_.toInteger(word);
    const long long i = written < 0 ? static_cast<long long>(before) + written : written - 1;
    if (written == 0 || i < 0 || i >= static_cast<long long>(count))
      text_.fail(std::string(what) + " " + std::to_string(written) +
                 " is out of range: there are " + std::to_string(written < 0 ? before : count) +
                 (written < 0 ? " so far" : ""));
    return static_cast<std::size_t>(i);
  }

  unsigned vertex(std::string_view corner) {
    std::string_view parts[3];
    for (int i = 0; i < 3; ++i) {
      const std::size_t slash = corner.find('/');
      parts[i] = corner.substr(0, slash);
      corner = slash == std::string_view::npos ? "" : corner.substr(slash + 1);
    }
    const Vec3f p = positions_[index(parts[0], positions_.size(), before_.positions, "vertex")];
    Vec2f uv(0);
    Vec3f n(0);
    unsigned given = 0;
    if (!parts[1].empty()) {
      uv = uvs_[index(parts[1], uvs_.size(), before_.uvs, "texture coordinate")];
      given |= 1;
      anyUv_ = true;
    }
    if (!parts[2].empty()) {
      n = normals_[index(parts[2], normals_.size(), before_.normals, "normal")];
      given |= 2;
      anyNormal_ = true;
    }
    const Key key{{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, group_, given};
    const auto [entry, isNew] =
        vertices_.try_emplace(key, static_cast<unsigned>(data_.positions.size()));
    if (isNew) {
      data_.positions.push_back(p);
      data_.normals.push_back(n);
      data_.uvs.push_back(uv);
    }
    return entry->second;
  }

  void useMaterial(const std::string& name) {
    std::vector<std::string>& names = data_.materialNames;
    // What came before the first name has none.
    if (names.empty() && !data_.triangles.empty()) names.emplace_back();
    const auto found = std::find(names.begin(), names.end(), name);
    material_ = static_cast<std::uint32_t>(found - names.begin());
    if (found == names.end()) names.push_back(name);
  }

  void readFace() {
    face_.clear();
    for (std::string_view word = text_.word(); !word.empty() && word[0] != '#'; word = text_.word())
      face_.push_back(vertex(word));
    if (face_.size() < 3) text_.fail("a face with " + std::to_string(face_.size()) + " corners");
    if (!addPolygon(data_, face_))
      text_.fail("a face that is not convex has " + std::to_string(face_.size()) +
                 " corners, more than " + std::to_string(kMostConcaveCorners));
    data_.materials.resize(data_.triangles.size(), material_);
  }

  MeshText text_;
  bool flip_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec2f> uvs_;
  std::unordered_map<Key, unsigned, KeyHash> vertices_;
  MeshData data_;
  std::vector<unsigned> face_;
  struct {
    std::size_t positions = 0, normals = 0, uvs = 0;
  } before_;  // that the file has before the face
  unsigned group_ = 0;
  std::uint32_t material_ = 0;
  bool anyNormal_ = false, anyUv_ = false;
};

}  // namespace

void requireMemoryFor(const std::string& mesh, double bytes) {
  constexpr double kAlways = 64e6;
  if (bytes <= kAlways) return;
  try {
    requireMemory(bytes, "it", "expected a smaller mesh");
  } catch (const MemoryError& e) {
    throw MeshError(mesh + ": " + e.what());
  }
}

std::string readMeshFile(const std::string& path) {
  try {
    const InputFile file(path, kLargestData);
    requireMemoryFor(path, static_cast<double>(file.size()));
    std::string text = file.whole();
    if (text.empty()) throw MeshError(path + ": the file is empty");
    return text;
  } catch (const InputFileError& e) {
    throw MeshError(path + ": " + e.why());
  }
}

MeshData loadObj(const std::string& path, bool flipTexCoords) {
  const std::string text = readMeshFile(path);
  return ObjReader(path, text, flipTexCoords).read();
}

std::vector<MeshData> splitByMaterial(const MeshData& data) {
  if (data.materials.empty()) return {data};
  constexpr unsigned kNone = ~0u;
  std::vector<MeshData> parts;
  for (std::uint32_t m = 0; m < data.materialNames.size(); ++m) {
    MeshData part;
    part.faceNormals = data.faceNormals;
    part.materialNames = {data.materialNames[m]};
    std::vector<unsigned> index(data.positions.size(), kNone);
    const auto vertex = [&](unsigned i) {
      if (index[i] != kNone) return index[i];
      index[i] = static_cast<unsigned>(part.positions.size());
      part.positions.push_back(data.positions[i]);
      if (!data.normals.empty()) part.normals.push_back(data.normals[i]);
      if (!data.uvs.empty()) part.uvs.push_back(data.uvs[i]);
      return index[i];
    };
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
      if (data.materials[i] != m) continue;
      const glm::uvec3& t = data.triangles[i];
      const unsigned a = vertex(t.x), b = vertex(t.y), c = vertex(t.z);
      part.triangles.emplace_back(a, b, c);
    }
    if (!part.triangles.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace h2mc
