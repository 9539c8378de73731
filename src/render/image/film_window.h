// SPDX-License-Identifier: MIT
// Pictures that are a part of a larger one.
#pragma once

namespace h2mc {

// Where in the whole picture a window's upper left pixel is, and how large the whole is.
struct FilmWindow {
  int x = 0, y = 0;
  int wholeWidth = 0, wholeHeight = 0;  // 0: the picture is the whole
  bool isPart() const { return wholeWidth > 0; }
  bool operator==(const FilmWindow&) const = default;
};

// A window by its upper left pixel and its size.
struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

}  // namespace h2mc
