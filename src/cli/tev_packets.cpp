// SPDX-License-Identifier: MIT
#include "cli/tev_packets.h"

#include <algorithm>
#include <bit>
#include <initializer_list>

namespace h2mc {
namespace {

enum class Kind : std::uint8_t {
  kCreateImage = 4,
  kUpdateImage = 6
};  // the third form of the update

constexpr int kChannels = 3;

class PacketWriter {
 public:
  explicit PacketWriter(Kind kind) : bytes_(sizeof(std::uint32_t)) {
    bytes_.push_back(static_cast<std::uint8_t>(kind));
  }
  void flag(bool value) { bytes_.push_back(value ? 1 : 0); }
  void text(const std::string& value) {
    for (const char c : value)
      if (c != '\0') bytes_.push_back(static_cast<std::uint8_t>(c));
    bytes_.push_back(0);
  }
  void number32(std::uint32_t value) { put(value, 4); }
  void number64(std::uint64_t value) { put(value, 8); }
  void numbers(std::initializer_list<int> values) {
    for (const int value : values) number32(static_cast<std::uint32_t>(value));
  }
  void channelNames() {
    for (const char* name : {"R", "G", "B"}) text(name);
  }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }
  // The packet with its length.
  Packet finish() {
    for (std::size_t i = 0; i < sizeof(std::uint32_t); ++i)
      bytes_[i] = static_cast<std::uint8_t>(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  void put(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }

  Packet bytes_;
};

}  // namespace

Packet createImagePacket(const std::string& name, int width, int height) {
  PacketWriter packet(Kind::kCreateImage);
  packet.flag(true);  // to be shown at once
  packet.text(name);
  packet.numbers({width, height, kChannels});
  packet.channelNames();
  return packet.finish();
}

Packet updateImagePacket(const std::string& name, const Image& image, int begin, int end) {
  PacketWriter packet(Kind::kUpdateImage);
  packet.flag(false);
  packet.text(name);
  packet.numbers({kChannels});
  packet.channelNames();
  packet.numbers({0, begin, image.width, end - begin});
  // Where a channel begins among the floats, and how far its values are from one another.
  for (int c = 0; c < kChannels; ++c) packet.number64(static_cast<std::uint64_t>(c));
  for (int c = 0; c < kChannels; ++c) packet.number64(kChannels);
  packet.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(end - begin) *
                 kChannels * sizeof(float));
  for (int y = begin; y < end; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < kChannels; ++c)
        packet.number32(std::bit_cast<std::uint32_t>(image.at(x, y)[c]));
  return packet.finish();
}

int rowsAPacket(int width) {
  constexpr int kFloats = 1 << 18;
  return std::max(1, kFloats / (kChannels * std::max(width, 1)));
}

}  // namespace h2mc
