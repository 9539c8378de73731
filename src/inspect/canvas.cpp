// SPDX-License-Identifier: MIT
#include "inspect/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/figure_file.h"
#include "render/core/index.h"
#include "render/image/color_encoding.h"

namespace h2mc {
namespace {

// Capitals are kTextHeight high.
constexpr double kFontSize = 19;
constexpr int kColumns = 5, kRows = 7, kTextScale = 2;

// Glyphs of 5 x 7 pixels from ' ' to '~': a number a row, the leftmost pixel its bit 4.
using Glyph = std::array<std::uint8_t, kRows>;
constexpr Glyph kGlyphs[] = {
    {0, 0, 0, 0, 0, 0, 0},        {4, 4, 4, 4, 4, 0, 4},        {10, 10, 0, 0, 0, 0, 0},
    {10, 31, 10, 10, 10, 31, 10}, {4, 15, 20, 14, 5, 30, 4},    {24, 25, 2, 4, 8, 19, 3},
    {12, 18, 20, 8, 21, 18, 13},  {4, 4, 0, 0, 0, 0, 0},        {2, 4, 8, 8, 8, 4, 2},
    {8, 4, 2, 2, 2, 4, 8},        {0, 4, 21, 14, 21, 4, 0},     {0, 4, 4, 31, 4, 4, 0},
    {0, 0, 0, 0, 12, 4, 8},       {0, 0, 0, 31, 0, 0, 0},       {0, 0, 0, 0, 0, 12, 12},
    {1, 1, 2, 4, 8, 16, 16},      {14, 17, 19, 21, 25, 17, 14}, {4, 12, 4, 4, 4, 4, 14},
    {14, 17, 1, 6, 8, 16, 31},    {30, 1, 1, 14, 1, 1, 30},     {2, 6, 10, 18, 31, 2, 2},
    {31, 16, 30, 1, 1, 17, 14},   {6, 8, 16, 30, 17, 17, 14},   {31, 1, 2, 2, 4, 4, 4},
    {14, 17, 17, 14, 17, 17, 14}, {14, 17, 17, 15, 1, 2, 12},   {0, 12, 12, 0, 12, 12, 0},
    {0, 12, 12, 0, 12, 4, 8},     {2, 4, 8, 16, 8, 4, 2},       {0, 0, 31, 0, 31, 0, 0},
    {8, 4, 2, 1, 2, 4, 8},        {14, 17, 1, 2, 4, 0, 4},      {14, 17, 23, 21, 23, 16, 14},
    {14, 17, 17, 31, 17, 17, 17}, {30, 17, 17, 30, 17, 17, 30}, {14, 17, 16, 16, 16, 17, 14},
    {28, 18, 17, 17, 17, 18, 28}, {31, 16, 16, 30, 16, 16, 31}, {31, 16, 16, 30, 16, 16, 16},
    {14, 17, 16, 23, 17, 17, 15}, {17, 17, 17, 31, 17, 17, 17}, {14, 4, 4, 4, 4, 4, 14},
    {7, 2, 2, 2, 2, 18, 12},      {17, 18, 20, 24, 20, 18, 17}, {16, 16, 16, 16, 16, 16, 31},
    {17, 27, 21, 21, 17, 17, 17}, {17, 25, 21, 19, 17, 17, 17}, {14, 17, 17, 17, 17, 17, 14},
    {30, 17, 17, 30, 16, 16, 16}, {14, 17, 17, 17, 21, 18, 13}, {30, 17, 17, 30, 20, 18, 17},
    {15, 16, 16, 14, 1, 1, 30},   {31, 4, 4, 4, 4, 4, 4},       {17, 17, 17, 17, 17, 17, 14},
    {17, 17, 17, 17, 17, 10, 4},  {17, 17, 17, 21, 21, 27, 17}, {17, 17, 10, 4, 10, 17, 17},
    {17, 17, 10, 4, 4, 4, 4},     {31, 1, 2, 4, 8, 16, 31},     {14, 8, 8, 8, 8, 8, 14},
    {16, 16, 8, 4, 2, 1, 1},      {14, 2, 2, 2, 2, 2, 14},      {4, 10, 17, 0, 0, 0, 0},
    {0, 0, 0, 0, 0, 0, 31},       {8, 4, 0, 0, 0, 0, 0},        {0, 0, 14, 1, 15, 17, 15},
    {16, 16, 30, 17, 17, 17, 30}, {0, 0, 14, 16, 16, 16, 14},   {1, 1, 15, 17, 17, 17, 15},
    {0, 0, 14, 17, 31, 16, 14},   {6, 8, 30, 8, 8, 8, 8},       {0, 0, 15, 17, 15, 1, 14},
    {16, 16, 30, 17, 17, 17, 17}, {4, 0, 12, 4, 4, 4, 14},      {2, 0, 6, 2, 2, 18, 12},
    {16, 16, 18, 20, 24, 20, 18}, {12, 4, 4, 4, 4, 4, 14},      {0, 0, 26, 21, 21, 21, 21},
    {0, 0, 30, 17, 17, 17, 17},   {0, 0, 14, 17, 17, 17, 14},   {0, 0, 30, 17, 30, 16, 16},
    {0, 0, 15, 17, 15, 1, 1},     {0, 0, 22, 25, 16, 16, 16},   {0, 0, 15, 16, 14, 1, 30},
    {8, 8, 30, 8, 8, 8, 6},       {0, 0, 17, 17, 17, 17, 15},   {0, 0, 17, 17, 17, 10, 4},
    {0, 0, 17, 17, 21, 21, 10},   {0, 0, 17, 10, 4, 10, 17},    {0, 0, 17, 17, 15, 1, 14},
    {0, 0, 31, 2, 4, 8, 31},      {2, 4, 4, 8, 4, 4, 2},        {4, 4, 4, 4, 4, 4, 4},
    {8, 4, 4, 2, 4, 4, 8},        {0, 0, 8, 21, 2, 0, 0},
};
static_assert(std::size(kGlyphs) == '~' - ' ' + 1);

Vec3f rgb(Canvas::Color color) {
  return Vec3f(static_cast<float>(color >> 16 & 255), static_cast<float>(color >> 8 & 255),
               static_cast<float>(color & 255)) /
         255.f;
}

// The words in a font; nothing where there is none.
TextMask inFont(const std::string& text) {
  return canDrawFigures() ? textMask(text, kFontSize) : TextMask();
}

// How much of a pixel is covered whose middle lies so far inside an edge.
double coverage(double inside) { return std::clamp(inside + 0.5, 0.0, 1.0); }

}  // namespace

Canvas::Canvas(int width, int height, Color background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), rgb(background)) {
  clip();
}

void Canvas::clip(int x, int y, int width, int height) {
  left_ = std::max(x, 0);
  top_ = std::max(y, 0);
  right_ = std::min(x + width, width_);
  bottom_ = std::min(y + height, height_);
}

void Canvas::pixel(int x, int y, Color color, double alpha) {
  if (x < left_ || x >= right_ || y < top_ || y >= bottom_ || alpha <= 0) return;
  Vec3f& p = pixels_[at(y) * at(width_) + static_cast<std::size_t>(x)];
  p = p + (rgb(color) - p) * static_cast<float>(std::min(alpha, 1.0));
}

void Canvas::rectangle(int x, int y, int width, int height, Color color, double alpha) {
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i) pixel(i, j, color, alpha);
}

void Canvas::frame(int x, int y, int width, int height, Color color) {
  rectangle(x, y, width, 1, color);
  rectangle(x, y + height - 1, width, 1, color);
  rectangle(x, y, 1, height, color);
  rectangle(x + width - 1, y, 1, height, color);
}

void Canvas::line(double x0, double y0, double x1, double y1, double thickness, Color color,
                  double alpha) {
  const double dx = x1 - x0, dy = y1 - y0, squares = dx * dx + dy * dy, reach = thickness / 2 + 1;
  for (int j = static_cast<int>(std::floor(std::max(std::min(y0, y1) - reach, double(top_))));
       j <= std::min(std::max(y0, y1) + reach, double(bottom_)); ++j)
    for (int i = static_cast<int>(std::floor(std::max(std::min(x0, x1) - reach, double(left_))));
         i <= std::min(std::max(x0, x1) + reach, double(right_)); ++i) {
      const double px = i + 0.5 - x0, py = j + 0.5 - y0;
      const double t = squares > 0 ? std::clamp((px * dx + py * dy) / squares, 0.0, 1.0) : 0;
      pixel(i, j, color, alpha * coverage(thickness / 2 - std::hypot(px - t * dx, py - t * dy)));
    }
}

void Canvas::dot(double x, double y, double radius, Color color, double alpha) {
  line(x, y, x, y, 2 * radius, color, alpha);
}

int Canvas::textWidth(const std::string& text) {
  const TextMask mask = inFont(text);
  return mask.cover.empty() ? kTextScale * ((kColumns + 1) * static_cast<int>(text.size()) - 1)
                            : mask.advance;
}

void Canvas::text(int x, int y, const std::string& text, Color color) {
  if (const TextMask mask = inFont(text); !mask.cover.empty()) {
    std::size_t i = 0;
    for (int row = 0; row < mask.height; ++row)
      for (int column = 0; column < mask.width; ++column, ++i)
        pixel(x + mask.left + column, y + kTextHeight + mask.top + row, color,
              mask.cover[i] / 255.0);
    return;
  }
  for (const char c : text) {
    const bool known = c >= ' ' && c <= '~';
    const Glyph& glyph = kGlyphs[known ? c - ' ' : '?' - ' '];
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column)
        if (glyph[at(row)] >> (kColumns - 1 - column) & 1)
          rectangle(x + kTextScale * column, y + kTextScale * row, kTextScale, kTextScale, color);
    x += kTextScale * (kColumns + 1);
  }
}

Image Canvas::image() const {
  Image image(width_, height_);
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    for (int c = 0; c < 3; ++c) image.pixels[i][c] = srgbToLinear(pixels_[i][c]);
  return image;
}

}  // namespace h2mc
