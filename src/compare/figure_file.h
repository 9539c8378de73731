// SPDX-License-Identifier: MIT
// Drawings as files, by a module that is loaded when one is asked for: cairo brings thirty libraries with it. A build
// without cairo has no module.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/figure.h"

namespace h2mc {

enum class FigureFormat { kSvg, kPdf };

// Whether this build can make them.
bool canDrawFigures();

// The file's bytes. Throws std::runtime_error: why not. Precondition: canDrawFigures().
std::string figureFile(const Figure& figure, FigureFormat format);

// Words as the shares of pixels that they cover, 0 to 255, row by row from the top.
struct TextMask {
  int left = 0, top = 0;  // of its upper left corner, from where the words begin on their base line
  int width = 0, height = 0;
  int advance = 0;  // pixels to where further words would begin
  std::vector<std::uint8_t> cover;
};

// `size`: of the font, in pixels. Nothing where no font is found. Precondition: canDrawFigures().
TextMask textMask(const std::string& text, double size);

// What the module defines under these names.
extern "C" void h2mcFigureFile(const Figure& figure, FigureFormat format, std::string& bytes);
extern "C" void h2mcTextMask(const std::string& text, double size, TextMask& mask);

}  // namespace h2mc
