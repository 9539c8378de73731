// SPDX-License-Identifier: MIT
// Mitsuba's serialized meshes, versions 3 and 4: several zlib streams in a file, with a table of
// where they start at its end. Numbers are little endian.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/core/input_file.h"
#include "render/geometry/mesh_data.h"
#include "render/geometry/mesh_text.h"

namespace h2mc {
namespace {

constexpr std::uint16_t kMagic = 0x041C;
enum Flags : std::uint32_t {
  kNormals = 0x0001,
  kTexCoords = 0x0002,
  kColors = 0x0008,
  kFaceNormals = 0x0010,
  kDouble = 0x2000,
};

template <class Value>
Value littleEndian(const unsigned char* bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Value); ++i) bits |= std::uint64_t{bytes[i]} << (8 * i);
  if constexpr (std::is_same_v<Value, float>) {
    const auto narrow = static_cast<std::uint32_t>(bits);
    float value;
    std::memcpy(&value, &narrow, sizeof value);
    return value;
  } else if constexpr (std::is_same_v<Value, double>) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  } else {
    return static_cast<Value>(bits);
  }
}

// Inflates as much as is asked for and no more, so that a wrong count in the header costs nothing.
class Inflater {
 public:
  Inflater(std::string name, const char* data, std::size_t size) : name_(std::move(name)) {
    if (inflateInit(&stream_) != Z_OK) throw MeshError(name_ + ": zlib cannot be started");
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data));
    stream_.avail_in = static_cast<uInt>(std::min<std::size_t>(size, ~uInt{0}));
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  template <class Value>
  Value read() {
    unsigned char bytes[sizeof(Value)];
    fill(bytes, sizeof bytes);
    return littleEndian<Value>(bytes);
  }

  // `count` floats, stored as float or double, in pieces of `width`.
  template <class Vector>
  std::vector<Vector> vectors(std::uint64_t count, int width, bool isDouble, const char* what) {
    std::vector<Vector> result;
    for (std::uint64_t i = 0; i < count; ++i) {
      Vector v(0);
      for (int j = 0; j < width; ++j) {
        v[j] = isDouble ? static_cast<float>(read<double>()) : read<float>();
        if (!std::isfinite(v[j]))
          throw MeshError(name_ + ": " + what + " " + std::to_string(i) + " is not finite");
      }
      result.push_back(v);
    }
    return result;
  }

 private:
  void fill(unsigned char* out, std::size_t size) {
    while (size > 0) {
      if (begin_ == end_) refill();
      const std::size_t n = std::min(size, end_ - begin_);
      std::memcpy(out, buffer_ + begin_, n);
      begin_ += n;
      out += n;
      size -= n;
    }
  }

  void refill() {
    begin_ = end_ = 0;
    if (ended_) throw MeshError(name_ + ": the mesh ends early");
    stream_.next_out = buffer_;
    stream_.avail_out = sizeof buffer_;
    const int result = inflate(&stream_, Z_NO_FLUSH);
    end_ = sizeof buffer_ - stream_.avail_out;
    ended_ = result == Z_STREAM_END;
    if (result != Z_OK && !ended_ && end_ == 0)
      throw MeshError(name_ + (result == Z_BUF_ERROR ? ": the file ends within the mesh"
                                                     : ": the compressed data is damaged"));
    if (end_ == 0 && ended_) throw MeshError(name_ + ": the mesh ends early");
  }

  std::string name_;
  z_stream stream_{};
  unsigned char buffer_[1 << 15];
  std::size_t begin_ = 0, end_ = 0;
  bool ended_ = false;
};

MeshData loadMesh(const std::string& path, const InputFile& file, int shapeIndex) {
  const std::uint64_t size = file.size();
  const auto bad = [&](const std::string& message) { return MeshError(path + ": " + message); };
  const auto bytesAt = [&](std::uint64_t offset, std::uint64_t count) {
    std::string bytes = file.bytes(offset, count);
    if (bytes.size() < count) throw bad("the file ends early");
    return bytes;
  };
  const auto number = [&]<class Value>(std::uint64_t offset, Value) {
    const std::string bytes = bytesAt(offset, sizeof(Value));
    return littleEndian<Value>(reinterpret_cast<const unsigned char*>(bytes.data()));
  };
  constexpr std::uint16_t k16 = 0;
  constexpr std::uint32_t k32 = 0;
  constexpr std::uint64_t k64 = 0;

  if (size < 8 || number(0, k16) != kMagic) throw bad("not a file of serialized meshes");
  const std::uint16_t fileVersion = number(2, k16);
  if (fileVersion != 3 && fileVersion != 4)
    throw bad("version " + std::to_string(fileVersion) + " is not supported, expected 3 or 4");
  const std::uint32_t count = number(size - 4, k32);
  const std::uint64_t width = fileVersion == 4 ? 8 : 4;  // of an entry of the table
  if (count == 0 || count > (size - 4) / width)
    throw bad("the table at the file's end is damaged: is the file cut short?");
  if (shapeIndex < 0 || static_cast<std::uint32_t>(shapeIndex) >= count)
    throw bad("there is no mesh " + std::to_string(shapeIndex) + ", the file has 0 to " +
              std::to_string(count - 1));
  const std::uint64_t table = size - 4 - count * width;
  const auto offsetOf = [&](std::uint64_t index) {
    const std::uint64_t entry = table + index * width;
    return width == 8 ? number(entry, k64) : std::uint64_t{number(entry, k32)};
  };
  const std::uint64_t offset = offsetOf(static_cast<std::uint64_t>(shapeIndex));
  if (offset > table || table - offset < 4) throw bad("the table at the file's end is damaged");
  std::uint64_t end = table;
  if (static_cast<std::uint32_t>(shapeIndex) + 1 < count) {
    const std::uint64_t next = offsetOf(static_cast<std::uint64_t>(shapeIndex) + 1);
    if (next > offset + 4 && next < table) end = next;
  }
  if (number(offset, k16) != kMagic)
    throw bad("mesh " + std::to_string(shapeIndex) + " does not start as a mesh does");
  const std::uint16_t version = number(offset + 2, k16);

  const std::string name = path + ", mesh " + std::to_string(shapeIndex);
  requireMemoryFor(name, static_cast<double>(end - offset));
  const std::string text = bytesAt(offset + 4, end - offset - 4);
  Inflater in(name, text.data(), text.size());
  const auto flags = in.read<std::uint32_t>();
  if (version == 4)
    while (in.read<char>() != 0) {  // the mesh's name
    }
  const auto vertexCount = in.read<std::uint64_t>(), triangleCount = in.read<std::uint64_t>();
  if (vertexCount == 0 || triangleCount == 0) throw MeshError(name + ": the mesh has no triangles");
  if (vertexCount > 0xFFFFFFFEull || triangleCount > 0xFFFFFFFEull)
    throw MeshError(name + ": the mesh is too large or its header is damaged");
  const bool isDouble = (flags & kDouble) != 0;
  const auto times = [&](std::uint32_t flag, double width) { return flags & flag ? width : 0.0; };
  const double perVertex = (isDouble ? sizeof(double) : sizeof(float)) *
                           (3 + times(kNormals, 3) + times(kTexCoords, 2) + times(kColors, 3));
  const double bytes = perVertex * static_cast<double>(vertexCount) +
                       sizeof(glm::uvec3) * static_cast<double>(triangleCount);
  constexpr double kMostDeflation = 1032;
  if (bytes > kMostDeflation * static_cast<double>(text.size()))
    throw MeshError(name + ": its header says " + std::to_string(vertexCount) + " vertices and " +
                    std::to_string(triangleCount) + " triangles, which " +
                    sizeText(static_cast<double>(text.size())) + " of the file can't hold");
  requireMemoryFor(name, bytes);
  MeshData data;
  data.faceNormals = (flags & kFaceNormals) != 0;
  data.positions = in.vectors<Vec3f>(vertexCount, 3, isDouble, "vertex");
  if (flags & kNormals) data.normals = in.vectors<Vec3f>(vertexCount, 3, isDouble, "normal");
  if (flags & kTexCoords)
    data.uvs = in.vectors<Vec2f>(vertexCount, 2, isDouble, "texture coordinate");
  if (flags & kColors) data.colors = in.vectors<Vec3f>(vertexCount, 3, isDouble, "colour");
  for (std::uint64_t i = 0; i < triangleCount; ++i) {
    glm::uvec3 t;
    for (int j = 0; j < 3; ++j) {
      t[j] = in.read<std::uint32_t>();
      if (t[j] >= vertexCount)
        throw MeshError(name + ": vertex " + std::to_string(t[j]) + " of triangle " +
                        std::to_string(i) + " is out of range, there are " +
                        std::to_string(vertexCount));
    }
    data.triangles.push_back(t);
  }
  return data;
}

}  // namespace

MeshData loadSerialized(const std::string& path, int shapeIndex) {
  try {
    // Only the mesh itself is read: a file may hold thousands.
    return loadMesh(path, InputFile(path, kLargestData), shapeIndex);
  } catch (const InputFileError& e) {
    throw MeshError(path + ": " + e.why());
  }
}

}  // namespace h2mc
