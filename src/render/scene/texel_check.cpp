// SPDX-License-Identifier: MIT
#include "render/scene/texel_check.h"

#include <fmt/format.h>

#include "ad/traits.h"
#include "render/scene/change_note.h"

namespace h2mc {
namespace {

struct BadTexels {
  long long count = 0;
  std::string first;

  void add(const Image& image, int x, int y) {
    const Rgbf& c = image.at(x, y);
    if (count++ == 0) first = fmt::format("pixel ({}, {}) is ({}, {}, {})", x, y, c.x, c.y, c.z);
  }
  std::string message(const Properties& p, const char* what) const {
    return fmt::format("\"{}\": {} {} {}; {}", p.file("filename"), count,
                       count == 1 ? "pixel is" : "pixels are", what, first);
  }
};

}  // namespace

std::optional<Image> mendedTexels(const Properties& p, const Image& image) {
  const bool mayBeNegative = p.texelsMayBeNegative();
  BadTexels notFinite, negative;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgbf& c = image.at(x, y);
      if (!ad::isFinite(c))
        notFinite.add(image, x, y);
      else if (!mayBeNegative && (c.x < 0 || c.y < 0 || c.z < 0))
        negative.add(image, x, y);
    }
  if (notFinite.count == 0 && negative.count == 0) return std::nullopt;
  if (notFinite.count > 0) p.refuse("filename", notFinite.message(p, "not finite"), "they are 0");
  if (negative.count > 0)
    p.tolerate("filename", negative.message(p, "negative"),
               "in files of version 0.x, and with --permissive, they are 0");
  noteChange(
      p, "filename",
      fmt::format("{} values that are negative or not finite", notFinite.count + negative.count),
      "0");
  Image mended = image;
  for (Rgbf& c : mended.pixels)
    for (float* v : {&c.x, &c.y, &c.z})
      if (!ad::isFinite(*v) || (!mayBeNegative && *v < 0)) *v = 0;
  return mended;
}

}  // namespace h2mc
