// SPDX-License-Identifier: MIT
#include "render/image/header_size.h"

#include <algorithm>
#include <stdexcept>

#include "render/core/index.h"

namespace h2mc {
namespace {

// `count` bytes from `offset` on as a number; 0 where there are not so many.
std::uint32_t littleEndian(const std::string& bytes, std::size_t offset, int count) {
  std::uint32_t value = 0;
  if (offset + at(count) > bytes.size()) return 0;
  for (int i = count - 1; i >= 0; --i)
    value = value << 8 | static_cast<unsigned char>(bytes[offset + at(i)]);
  return value;
}
std::uint32_t bigEndian(const std::string& bytes, std::size_t offset, int count) {
  std::uint32_t value = 0;
  if (offset + at(count) > bytes.size()) return 0;
  for (int i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[offset + at(i)]);
  return value;
}

HeaderSize sizeOfBmp(const std::string& head) {
  if (littleEndian(head, 14, 4) == 12)
    return {littleEndian(head, 18, 2), littleEndian(head, 20, 2)};
  const auto magnitude = [](std::uint32_t v) {
    return v >> 31 ? 0 - v : v;
  };  // negative: upside down
  return {littleEndian(head, 18, 4), magnitude(littleEndian(head, 22, 4))};
}

std::optional<HeaderSize> sizeOfWebp(const std::string& head) {
  const std::string kind = head.substr(12, 4);
  if (kind == "VP8X")
    return HeaderSize{littleEndian(head, 24, 3) + 1, littleEndian(head, 27, 3) + 1};
  if (kind == "VP8L") {
    const std::uint32_t bits = littleEndian(head, 21, 4);
    return HeaderSize{(bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1};
  }
  if (kind == "VP8 ")
    return HeaderSize{littleEndian(head, 26, 2) & 0x3FFF, littleEndian(head, 28, 2) & 0x3FFF};
  return std::nullopt;
}

// Of the first frame header among the markers.
std::optional<HeaderSize> sizeOfJpeg(const InputFile& file) {
  constexpr int kMostMarkers = 1000000;
  constexpr std::uint64_t kBlock = 256;
  std::uint64_t offset = 2;
  for (int i = 0; i < kMostMarkers; ++i) {
    const std::string head = file.bytes(offset, 9);
    if (head.size() < 9) return std::nullopt;
    const std::uint32_t first = bigEndian(head, 0, 1), marker = bigEndian(head, 1, 1);
    if (first != 0xFF || marker == 0xFF) {
      // Padding: to the 0xFF before the next other byte, or to the next 0xFF.
      const std::string block = file.bytes(offset, kBlock);
      const std::size_t next = first == 0xFF ? block.find_first_not_of('\xFF') : block.find('\xFF');
      offset += std::min(next, block.size()) - (first == 0xFF);
      continue;
    }
    const bool isTable = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !isTable)
      return HeaderSize{bigEndian(head, 7, 2), bigEndian(head, 5, 2)};
    const bool isAlone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    offset += isAlone ? 2 : 2 + std::max(bigEndian(head, 2, 2), 2u);
  }
  throw std::runtime_error("it has no picture among its first " + std::to_string(kMostMarkers) +
                           " markers");
}

// The data window, or a tile where that is larger: OpenEXR makes room for a whole one. Of the (first) header, whose
// attributes are each its name, its type, how long it is, and that many bytes.
std::optional<HeaderSize> sizeOfExr(const InputFile& file) {
  constexpr int kMostAttributes = 10000;
  constexpr std::uint64_t kLongestName = 255;
  std::uint64_t offset = 8;  // past magic number and version
  std::optional<HeaderSize> largest;
  const auto see = [&](std::uint32_t width, std::uint32_t height) {
    const auto pixels = [](const HeaderSize& s) { return std::uint64_t{s.width} * s.height; };
    const HeaderSize size{width, height};
    if (!largest || pixels(size) > pixels(*largest)) largest = size;
  };
  for (int i = 0; i < kMostAttributes; ++i) {
    const std::string head = file.bytes(offset, 2 * (kLongestName + 1) + 4 + 16);
    const std::size_t type = head.find('\0') + 1;
    if (type <= 1) break;  // the header's end, or no name
    const std::size_t size = head.find('\0', type) + 1;
    if (size == 0 || size + 4 > head.size()) break;
    const std::size_t data = size + 4;
    const auto number = [&](std::size_t k) { return littleEndian(head, data + 4 * k, 4); };
    const auto extent = [&](std::size_t k) {
      const auto edge = [&](std::size_t e) {
        return std::int64_t{static_cast<std::int32_t>(number(e))};
      };
      return static_cast<std::uint32_t>(std::max<std::int64_t>(edge(k + 2) - edge(k) + 1, 0));
    };
    const std::string_view name(head.data(), type - 1);
    if (name == "dataWindow") see(extent(0), extent(1));
    if (name == "tiles") see(number(0), number(1));
    offset += data + littleEndian(head, size, 4);
  }
  return largest;
}

// The largest of the sizes ("ispe") in the file's descriptions ("meta"), which may stand anywhere among its boxes.
HeaderSize sizeOfHeif(const InputFile& file) {
  constexpr int kMostBoxes = 10000;
  constexpr std::uint64_t kMostRead = 1 << 20;
  HeaderSize largest;
  std::uint64_t offset = 0;
  for (int i = 0; i < kMostBoxes; ++i) {
    const std::string head = file.bytes(offset, 16);
    if (head.size() < 8) break;
    std::uint64_t size = bigEndian(head, 0, 4);
    if (size == 1) size = std::uint64_t{bigEndian(head, 8, 4)} << 32 | bigEndian(head, 12, 4);
    if (size == 0) size = file.size() - offset;  // to the end
    if (head.compare(4, 4, "meta") == 0) {
      const std::string box = file.bytes(offset, std::min(size, kMostRead));
      for (std::size_t k = box.find("ispe"); k != std::string::npos; k = box.find("ispe", k + 4)) {
        largest.width = std::max(largest.width, bigEndian(box, k + 8, 4));
        largest.height = std::max(largest.height, bigEndian(box, k + 12, 4));
      }
    }
    if (size < 8 || size > file.size() - offset) break;
    offset += size;
  }
  return largest;
}

}  // namespace

std::optional<HeaderSize> headerSize(const InputFile& file) {
  const std::string head = file.bytes(0, 30);
  const auto has = [&](std::size_t offset, std::string_view magic) {
    return head.size() >= offset + magic.size() && head.compare(offset, magic.size(), magic) == 0;
  };
  if (has(0, "\x76\x2f\x31\x01")) return sizeOfExr(file);
  if (has(0, "GIF8")) return HeaderSize{littleEndian(head, 6, 2), littleEndian(head, 8, 2)};
  if (has(0, "BM")) return sizeOfBmp(head);
  if (has(0, "RIFF") && has(8, "WEBP")) return sizeOfWebp(head);
  if (has(0, "\xFF\xD8\xFF")) return sizeOfJpeg(file);
  if (has(4, "ftyp")) return sizeOfHeif(file);
  return std::nullopt;
}

}  // namespace h2mc
