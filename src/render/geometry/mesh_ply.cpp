// SPDX-License-Identifier: MIT
// The Stanford polygon format: ascii and binary of either byte order.
#include <algorithm>
#include <bit>
#include <cstring>

#include "render/geometry/mesh_data.h"
#include "render/geometry/mesh_polygon.h"
#include "render/geometry/mesh_text.h"

namespace h2mc {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class Format { kAscii, kLittle, kBig };

std::size_t sizeOf(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kDouble:
      return 8;
    default:
      return 4;
  }
}

// The number that stands for 1 where a colour is of this type.
float largestOf(Type type) {
  switch (type) {
    case Type::kInt8:
      return 127;
    case Type::kUint8:
      return 255;
    case Type::kInt16:
      return 32767;
    case Type::kUint16:
      return 65535;
    case Type::kInt32:
      return 2147483647.0f;
    case Type::kUint32:
      return 4294967295.0f;
    default:
      return 1;
  }
}

struct Property {
  std::string name;
  bool list = false;
  Type countType = Type::kUint8, type = Type::kFloat;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const std::string& path, const std::string& text, bool flip)
      : path_(path), data_(text), text_(path, text), flip_(flip) {}

  MeshData read() {
    readHeader();
    at_ = text_.offset();
    checkSize();
    for (const Element& element : elements_) readElement(element);
    if (mesh_.positions.empty()) fail("the mesh has no vertices");
    for (const std::vector<unsigned>& face : waiting_) addFace(face);
    if (mesh_.triangles.empty()) fail("the mesh has no faces");
    for (const glm::uvec3& t : mesh_.triangles)
      for (int i = 0; i < 3; ++i) requireVertex(t[i]);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw MeshError(path_ + ": " + message);
  }

  Type type(std::string_view name) const {
    if (name == "char" || name == "int8") return Type::kInt8;
    if (name == "uchar" || name == "uint8") return Type::kUint8;
    if (name == "short" || name == "int16") return Type::kInt16;
    if (name == "ushort" || name == "uint16") return Type::kUint16;
    if (name == "int" || name == "int32") return Type::kInt32;
    if (name == "uint" || name == "uint32") return Type::kUint32;
    if (name == "float" || name == "float32") return Type::kFloat;
    if (name == "double" || name == "float64") return Type::kDouble;
    text_.fail("unknown type \"" + std::string(name.substr(0, 40)) + "\"");
  }

  void readHeader() {
    if (!text_.nextLine() || text_.word() != "ply") fail("not a PLY file");
    bool formatGiven = false;
    while (text_.nextLine()) {
      const std::string_view keyword = text_.word();
      if (keyword == "end_header") {
        if (!formatGiven) fail("the header names no format");
        return;
      }
      if (keyword == "format") {
        const std::string_view name = text_.word();
        if (name == "ascii") {
          format_ = Format::kAscii;
        } else if (name == "binary_little_endian") {
          format_ = Format::kLittle;
        } else if (name == "binary_big_endian") {
          format_ = Format::kBig;
        } else {
          text_.fail("unknown format \"" + std::string(name.substr(0, 40)) + "\"");
        }
        formatGiven = true;
      } else if (keyword == "element") {
        Element element;
        element.name = text_.word();
        const long long count = text_.toInteger(text_.word());
        // Every element takes a byte at least.
        if (count < 0 || static_cast<std::size_t>(count) > data_.size())
          text_.fail("the file is too short for " + std::to_string(count) + " of \"" +
                     element.name + "\"");
        element.count = static_cast<std::size_t>(count);
        elements_.push_back(element);
      } else if (keyword == "property") {
        if (elements_.empty()) text_.fail("a property before any element");
        Property property;
        std::string_view word = text_.word();
        if (word == "list") {
          property.list = true;
          property.countType = type(text_.word());
          word = text_.word();
        }
        property.type = type(word);
        property.name = text_.word();
        elements_.back().properties.push_back(property);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        text_.fail("unknown keyword \"" + std::string(keyword.substr(0, 40)) + "\" in the header");
      }
    }
    fail("the header has no end");
  }

  // What the header promises has to fit into the rest of the file.
  void checkSize() const {
    double least = 0;
    for (const Element& element : elements_) {
      double bytes = 0;
      for (const Property& p : element.properties)
        bytes += format_ == Format::kAscii
                     ? 2
                     : static_cast<double>(sizeOf(p.list ? p.countType : p.type));
      least += bytes * static_cast<double>(element.count);
    }
    // The last number of a text needs no blank after it.
    const double rest = static_cast<double>(data_.size() - at_) + 1;
    if (least <= rest) return;
    std::string counts;
    for (const Element& element : elements_)
      counts += (counts.empty() ? "" : ", ") + std::to_string(element.count) + " of \"" +
                element.name + "\"";
    fail("the file is too short for what its header says: " + counts);
  }

  double number(Type type) {
    if (format_ == Format::kAscii) {
      std::string_view word = text_.word();
      while (word.empty()) {
        if (!text_.nextLine()) fail("the file ends early");
        word = text_.word();
      }
      return type == Type::kFloat || type == Type::kDouble
                 ? static_cast<double>(text_.toNumber(word))
                 : static_cast<double>(text_.toInteger(word));
    }
    const std::size_t size = sizeOf(type);
    if (data_.size() - at_ < size) fail("the file ends early");
    unsigned char bytes[8];
    std::memcpy(bytes, data_.data() + at_, size);
    at_ += size;
    const bool little = std::endian::native == std::endian::little;
    if (little != (format_ == Format::kLittle)) std::reverse(bytes, bytes + size);
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(bytes);
      case Type::kUint8:
        return as<std::uint8_t>(bytes);
      case Type::kInt16:
        return as<std::int16_t>(bytes);
      case Type::kUint16:
        return as<std::uint16_t>(bytes);
      case Type::kInt32:
        return as<std::int32_t>(bytes);
      case Type::kUint32:
        return as<std::uint32_t>(bytes);
      case Type::kFloat:
        return static_cast<double>(as<float>(bytes));
      case Type::kDouble:
        return as<double>(bytes);
    }
    return 0;
  }

  template <class Value>
  static Value as(const unsigned char* bytes) {
    Value value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  void readElement(const Element& element) {
    if (element.name == "vertex") {
      readVertices(element);
    } else if (element.name == "face") {
      readFaces(element);
    } else if (element.name == "tristrips") {
      readStrips(element);
    } else {
      for (std::size_t i = 0; i < element.count; ++i)
        for (const Property& p : element.properties) skip(p);
    }
  }

  void skip(const Property& property) {
    std::size_t count = 1;
    if (property.list) count = listCount(property);
    for (std::size_t i = 0; i < count; ++i) number(property.type);
  }

  std::size_t listCount(const Property& property) {
    const double count = number(property.countType);
    if (!(count >= 0) || count > static_cast<double>(data_.size())) fail("a list has a bad length");
    return static_cast<std::size_t>(count);
  }

  void readVertices(const Element& element) {
    if (!mesh_.positions.empty()) fail("two lists of vertices");
    // Where each property goes: 0-2 position, 3-5 normal, 6-7 texture coordinates, 8-10 colour.
    static const std::pair<const char*, int> kTargets[] = {{"x", 0},
                                                           {"y", 1},
                                                           {"z", 2},
                                                           {"nx", 3},
                                                           {"ny", 4},
                                                           {"nz", 5},
                                                           {"u", 6},
                                                           {"v", 7},
                                                           {"s", 6},
                                                           {"t", 7},
                                                           {"texture_u", 6},
                                                           {"texture_v", 7},
                                                           {"red", 8},
                                                           {"green", 9},
                                                           {"blue", 10},
                                                           {"diffuse_red", 8},
                                                           {"diffuse_green", 9},
                                                           {"diffuse_blue", 10},
                                                           {"r", 8},
                                                           {"g", 9},
                                                           {"b", 10},
                                                           {"color_r", 8},
                                                           {"color_g", 9},
                                                           {"color_b", 10}};
    std::vector<int> targets;
    bool has[11] = {};
    float largest = 1;  // of colours
    for (const Property& p : element.properties) {
      int target = -1;
      for (const auto& [name, index] : kTargets)
        if (p.name == name && !p.list) target = index;
      targets.push_back(target);
      if (target >= 0) has[target] = true;
      if (target == 8) largest = largestOf(p.type);
    }
    if (!has[0] || !has[1] || !has[2]) fail("the vertices have no x, y, z");
    const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7];
    const bool colors = has[8] && has[9] && has[10];
    mesh_.integerColors = colors && largest > 1;
    for (std::size_t i = 0; i < element.count; ++i) {
      float values[11] = {};
      for (std::size_t j = 0; j < targets.size(); ++j) {
        if (targets[j] < 0) {
          skip(element.properties[j]);
          continue;
        }
        values[targets[j]] = static_cast<float>(number(element.properties[j].type));
        if (!std::isfinite(values[targets[j]]))
          fail("\"" + element.properties[j].name + "\" of vertex " + std::to_string(i) +
               " is not a finite number");
      }
      mesh_.positions.emplace_back(values[0], values[1], values[2]);
      if (normals) mesh_.normals.emplace_back(values[3], values[4], values[5]);
      if (colors)
        mesh_.colors.emplace_back(values[8] / largest, values[9] / largest, values[10] / largest);
      if (uvs) mesh_.uvs.emplace_back(values[6], flip_ ? 1 - values[7] : values[7]);
    }
  }

  void requireVertex(unsigned v) const {
    if (v >= mesh_.positions.size())
      fail("vertex " + std::to_string(v) + " of a face is out of range: there are " +
           std::to_string(mesh_.positions.size()));
  }

  void addFace(const std::vector<unsigned>& face) {
    if (face.size() == 3) {
      mesh_.triangles.emplace_back(face[0], face[1], face[2]);
    } else if (mesh_.positions.empty()) {
      waiting_.push_back(face);
    } else {
      for (const unsigned v : face) requireVertex(v);
      if (!addPolygon(mesh_, face))
        fail("a face that is not convex has " + std::to_string(face.size()) +
             " corners, more than " + std::to_string(kMostConcaveCorners));
    }
  }

  void readFaces(const Element& element) {
    std::vector<unsigned> face;
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& p : element.properties) {
        if (!p.list || (p.name != "vertex_indices" && p.name != "vertex_index")) {
          skip(p);
          continue;
        }
        const std::size_t corners = listCount(p);
        if (corners < 3) fail("face " + std::to_string(i) + " has fewer than 3 corners");
        face.clear();
        for (std::size_t c = 0; c < corners; ++c)
          face.push_back(vertexOf(number(p.type), "face", i));
        addFace(face);
      }
    }
  }

  // Each corner makes a triangle with the two before it, every other one turned round; -1 begins anew.
  void readStrips(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i)
      for (const Property& p : element.properties) {
        if (!p.list || (p.name != "vertex_indices" && p.name != "vertex_index")) {
          skip(p);
          continue;
        }
        const std::size_t corners = listCount(p);
        unsigned a = 0, b = 0;
        std::size_t inStrip = 0;
        for (std::size_t c = 0; c < corners; ++c) {
          const double index = number(p.type);
          if (index == -1) {
            inStrip = 0;
            continue;
          }
          const unsigned v = vertexOf(index, "strip", i);
          if (inStrip >= 2)
            mesh_.triangles.push_back(inStrip % 2 ? glm::uvec3(b, a, v) : glm::uvec3(a, b, v));
          a = b;
          b = v;
          ++inStrip;
        }
      }
  }

  unsigned vertexOf(double index, const std::string& what, std::size_t i) const {
    if (!(index >= 0 && index < 4294967295.0))
      fail(what + " " + std::to_string(i) + " has a bad vertex");
    return static_cast<unsigned>(index);
  }

  std::string path_;
  const std::string& data_;
  mutable MeshText text_;
  bool flip_;
  Format format_ = Format::kAscii;
  std::vector<Element> elements_;
  std::size_t at_ = 0;
  MeshData mesh_;
  std::vector<std::vector<unsigned>> waiting_;  // for the vertices, which the file has later
};

}  // namespace

MeshData loadPly(const std::string& path, bool flipTexCoords) {
  const std::string text = readMeshFile(path);
  return PlyReader(path, text, flipTexCoords).read();
}

}  // namespace h2mc
