// SPDX-License-Identifier: MIT
// Pictures in memory.
#pragma once

#include <string>
#include <vector>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/core/types.h"

namespace h2mc {

// Linear RGB, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgbf> pixels;

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, Rgbf(0)) {}
  Rgbf& at(int x, int y) { return pixels[h2mc::at(y) * width + x]; }
  void archive(Archive& archive) { archive(width, height, pixels); }
  const Rgbf& at(int x, int y) const { return pixels[h2mc::at(y) * width + x]; }
};

// Means of blocks of factor x factor pixels; the sizes must be multiples of the factor.
Image averaged(const Image& image, int factor);

}  // namespace h2mc
