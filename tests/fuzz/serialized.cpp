// SPDX-License-Identifier: MIT
// Mitsuba's serialized meshes. What is interesting about them is compressed: the mutator changes what comes out of
// zlib, and compresses that again.
#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "fuzz_target.h"
#include "input_folder.h"
#include "mesh_promises.h"

namespace h2mc::fuzz {
namespace {

constexpr std::size_t kHeader = 4, kMostInflated = 1 << 16;

std::string littleEndian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i, value >>= 8) text += static_cast<char>(value & 0xff);
  return text;
}

// The first mesh's content; "" where there is none.
std::string inflated(const std::string& file) {
  if (file.size() <= kHeader) return "";
  std::string content(kMostInflated, '\0');
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return "";
  std::string compressed = file.substr(kHeader);
  stream.next_in = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(content.data());
  stream.avail_out = static_cast<uInt>(content.size());
  inflate(&stream, Z_NO_FLUSH);
  content.resize(content.size() - stream.avail_out);
  inflateEnd(&stream);
  return content;
}

std::string deflated(const std::string& content) {
  uLongf size = compressBound(static_cast<uLong>(content.size()));
  std::string compressed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
            reinterpret_cast<const Bytef*>(content.data()), static_cast<uLong>(content.size()), 1);
  compressed.resize(size);
  return compressed;
}

// A file of `count` times the same mesh.
std::string fileOf(const std::string& header, const std::string& content, std::size_t count) {
  const int width = header[2] == 4 ? 8 : 4;
  std::string file, table;
  for (std::size_t i = 0; i < count; ++i) {
    table += littleEndian(file.size(), width);
    file += header + deflated(content);
  }
  return file + table + littleEndian(count, 4);
}

}  // namespace

void readInput(const std::string& input) {
  const std::string file = inputFolder().write("input.serialized", input);
  checkMesh(loadSerialized(file, 0));
  checkMesh(loadSerialized(file, 1));
}

std::string mutateInput(const std::string& input, Random& random, const ByteMutator& bytes,
                        std::size_t most) {
  const std::string content = inflated(input);
  if (content.empty() || random.chance(0.2)) return bytes(input, most);
  const std::string changed = bytes(content, kMostInflated);
  const std::string file = fileOf(input.substr(0, kHeader), changed, 1 + random.below(2));
  return file.size() <= most ? file : bytes(input, most);
}

std::span<const std::string_view> words() {
  using namespace std::string_view_literals;
  static constexpr std::string_view kWords[] = {"\x1c\x04\x03\x00"sv,
                                                "\x1c\x04\x04\x00"sv,
                                                "\x00\x00\x80\x7f"sv,
                                                "\x00\x00\xc0\x7f"sv,
                                                "\x0b\x10\x00\x00"sv,
                                                "\x0b\x20\x00\x00"sv,
                                                "\x01\x00\x00\x00\x00\x00\x00\x00"sv,
                                                "\x03\x00\x00\x00\x00\x00\x00\x00"sv};
  return kWords;
}

}  // namespace h2mc::fuzz
