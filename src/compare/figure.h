// SPDX-License-Identifier: MIT
// Drawings for papers, as data: what is where, in points (1/72 inch) from the upper left corner.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace h2mc {

struct FigurePoint {
  double x = 0, y = 0;
};
struct FigureBox {
  double x = 0, y = 0, width = 0, height = 0;
};
struct FigureColor {
  double red = 0, green = 0, blue = 0, alpha = 1;
};

struct FigureLine {
  std::vector<FigurePoint> points;
  FigureColor color;
  double width = 1;
  bool dashed = false;
  bool closed = false;
  std::optional<FigureBox> clip{};
};
struct FigureArea {
  std::vector<FigurePoint> points;
  FigureColor color;
  std::optional<FigureBox> clip{};
};
struct FigureDisk {
  FigurePoint centre;
  double radius = 1;
  FigureColor color;
};
struct FigureText {
  enum class Anchor { kStart, kMiddle, kEnd };
  FigurePoint at;  // on the base line
  std::string text;
  double size = 8;
  Anchor anchor = Anchor::kStart;
  bool bold = false;
  bool upwards = false;  // turned by a quarter
  FigureColor color{};
};
// Each pixel stays a square of one colour, however large it becomes.
struct FigurePicture {
  FigureBox box;
  int width = 0, height = 0;
  std::vector<std::uint8_t> srgb;  // three a pixel, row by row from the top
};

using FigureShape = std::variant<FigureLine, FigureArea, FigureDisk, FigureText, FigurePicture>;

// The text, cut short where it would be wider; letters are taken as of one width.
std::string fitted(const std::string& text, double size, double width);
// Its width, likewise.
double widthOf(const std::string& text, double size);

struct Figure {
  double width = 0, height = 0;
  std::vector<FigureShape> shapes;  // later ones above earlier ones
};

}  // namespace h2mc
