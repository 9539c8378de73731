// SPDX-License-Identifier: MIT
// Sizes in the headers of pictures that OpenImageIO decodes, wholly or in part, or makes room for as it opens them.
#pragma once

#include <cstdint>
#include <optional>

#include "render/core/input_file.h"

namespace h2mc {

struct HeaderSize {
  std::uint32_t width = 0, height = 0;  // in pixels
};

// Of an EXR, a GIF, a BMP, a WebP, a JPEG, and of the largest picture in an HEIF or AVIF; nothing of other formats,
// whose size OpenImageIO tells before it reads more, and where the header is damaged. Throws std::runtime_error for a
// JPEG without an end of its markers.
std::optional<HeaderSize> headerSize(const InputFile& file);

}  // namespace h2mc
