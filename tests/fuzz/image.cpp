// SPDX-License-Identifier: MIT
// Pictures, by way of the loader that bitmaps and environment maps have. The mutator makes the checksums of PNG right
// again: what is behind them is of more interest than that they are looked at.
#include <zlib.h>

#include <cmath>
#include <cstdint>

#include "fuzz_target.h"
#include "input_folder.h"
#include "render/image/image_io.h"

namespace h2mc::fuzz {
namespace {

using namespace std::string_view_literals;
constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n"sv, kExr = "\x76\x2f\x31\x01"sv;

// The loader goes by the name first.
std::string nameFor(const std::string& input) {
  if (input.starts_with(kPng.substr(0, 4))) return "input.png";
  if (input.starts_with(kExr)) return "input.exr";
  return "input.hdr";
}

std::uint32_t bigEndian(const std::string& text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(text[at + i]);
  return value;
}

void repairChecksums(std::string& png) {
  std::size_t at = kPng.size();
  while (at + 12 <= png.size()) {
    const std::uint64_t length = bigEndian(png, at);
    if (at + 12 + length > png.size()) return;
    const auto* const chunk = reinterpret_cast<const Bytef*>(png.data() + at + 4);
    std::uint64_t sum = crc32(0, chunk, static_cast<uInt>(length + 4));
    for (std::size_t i = 4; i-- > 0; sum >>= 8)
      png[at + 8 + length + i] = static_cast<char>(sum & 0xff);
    at += 12 + length;
  }
}

}  // namespace

void readInput(const std::string& input) {
  const std::string file = inputFolder().write(nameFor(input), input);
  for (const float gamma : {0.f, 2.2f}) {
    const Image image = readImage(file, gamma);
    if (image.width <= 0 || image.height <= 0 ||
        image.pixels.size() !=
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      throw Finding("an image without pixels");
  }
  readImage(file, 0, "y");
}

std::string mutateInput(const std::string& input, Random& random, const ByteMutator& bytes,
                        std::size_t most) {
  std::string changed = bytes(input, most);
  if (changed.starts_with(kPng) && random.chance(0.9)) repairChecksums(changed);
  return changed;
}

std::span<const std::string_view> words() {
  static constexpr std::string_view kWords[] = {kPng,
                                                kExr,
                                                "#?RADIANCE\n",
                                                "FORMAT=32-bit_rle_rgbe\n",
                                                "EXPOSURE=",
                                                "-Y 4 +X 8\n",
                                                "+X 8 +Y 4\n",
                                                "GAMMA=2.2\n",
                                                "IHDR",
                                                "IDAT",
                                                "IEND",
                                                "gAMA",
                                                "sRGB",
                                                "PLTE",
                                                "tRNS",
                                                "iCCP",
                                                "channels\0chlist\0"sv,
                                                "compression\0compression\0"sv,
                                                "dataWindow\0box2i\0"sv,
                                                "displayWindow\0box2i\0"sv,
                                                "lineOrder\0lineOrder\0"sv,
                                                "tiles\0tiledesc\0"sv,
                                                "chunkCount\0int\0"sv,
                                                "R\0\0\0\0\0"sv,
                                                "\x00\x00\x80\x7f"sv,
                                                "\x02\x02\x00\x08"sv};
  return kWords;
}

}  // namespace h2mc::fuzz
