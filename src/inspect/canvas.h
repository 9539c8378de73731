// SPDX-License-Identifier: MIT
// Lines, dots and text on a picture: enough for plots.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace h2mc {

// Blends in sRGB, as browsers do. Positions in pixels from the upper left corner; pixel centres are at
// .5. What is not on the canvas is left out.
class Canvas {
 public:
  // 0xrrggbb
  using Color = std::uint32_t;

  Canvas(int width, int height, Color background);

  void pixel(int x, int y, Color color, double alpha = 1);
  void rectangle(int x, int y, int width, int height, Color color, double alpha = 1);
  void frame(int x, int y, int width, int height, Color color);
  void line(double x0, double y0, double x1, double y1, double thickness, Color color,
            double alpha = 1);
  void dot(double x, double y, double radius, Color color, double alpha = 1);
  // Printable ASCII; (x, y) is the upper left corner of a capital. In a font where this build has cairo and the machine
  // a font, else in letters of 5 x 7 dots.
  void text(int x, int y, const std::string& text, Color color);
  static int textWidth(const std::string& text);
  static constexpr int kTextHeight = 14;

  // Confines what is drawn to a rectangle; the whole canvas without arguments.
  void clip(int x, int y, int width, int height);
  void clip() { clip(0, 0, width_, height_); }

  // In linear RGB.
  Image image() const;

 private:
  int width_, height_;
  int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
  std::vector<Vec3f> pixels_;  // sRGB in [0, 1]
};

}  // namespace h2mc
