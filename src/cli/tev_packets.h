// SPDX-License-Identifier: MIT
// What the viewer tev is told over its connection: https://github.com/Tom94/tev, "IPC". Each packet is its length in
// bytes, itself included, as 32 bits, a byte for its kind, and its fields one after the other; all little endian,
// flags a byte each, text ended by a zero byte.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace h2mc {

using Packet = std::vector<std::uint8_t>;

// Makes an empty picture with the channels R, G and B, and shows it. One of this name is replaced.
Packet createImagePacket(const std::string& name, int width, int height);

// Rows [begin, end) of the picture.
Packet updateImagePacket(const std::string& name, const Image& image, int begin, int end);

// As many rows as fit into a packet of about a megabyte, at least one.
int rowsAPacket(int width);

}  // namespace h2mc
