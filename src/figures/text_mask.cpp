// SPDX-License-Identifier: MIT
// The part of the module that textMask() calls.
#include <cairo.h>

#include <cmath>

#include "compare/figure_file.h"

namespace h2mc {
namespace {

void choose(cairo_t* cairo, double size) {
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, size);
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
}

}  // namespace

extern "C" void h2mcTextMask(const std::string& text, double size, TextMask& mask) {
  // What is measured needs no more than a pixel.
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* cairo = cairo_create(surface);
  choose(cairo, size);
  cairo_text_extents_t extents{};
  cairo_text_extents(cairo, text.c_str(), &extents);
  const bool found = cairo_status(cairo) == CAIRO_STATUS_SUCCESS;
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  if (!found || !(extents.width > 0)) return;

  mask.left = static_cast<int>(std::floor(extents.x_bearing)) - 1;
  mask.top = static_cast<int>(std::floor(extents.y_bearing)) - 1;
  mask.width = static_cast<int>(std::ceil(extents.x_bearing + extents.width)) + 1 - mask.left;
  mask.height = static_cast<int>(std::ceil(extents.y_bearing + extents.height)) + 1 - mask.top;
  mask.advance = static_cast<int>(std::lround(extents.x_advance));
  surface = cairo_image_surface_create(CAIRO_FORMAT_A8, mask.width, mask.height);
  cairo = cairo_create(surface);
  choose(cairo, size);
  cairo_move_to(cairo, -mask.left, -mask.top);
  cairo_show_text(cairo, text.c_str());
  cairo_surface_flush(surface);
  const unsigned char* const rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  if (rows && cairo_status(cairo) == CAIRO_STATUS_SUCCESS)
    for (int y = 0; y < mask.height; ++y) {
      const unsigned char* const row = rows + static_cast<std::ptrdiff_t>(y) * stride;
      mask.cover.insert(mask.cover.end(), row, row + mask.width);
    }
  else
    mask = {};
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
}

}  // namespace h2mc
