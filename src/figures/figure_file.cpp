// SPDX-License-Identifier: MIT
// The module that figureFile() loads.
#include "compare/figure_file.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <memory>
#include <numbers>
#include <stdexcept>

namespace h2mc {
namespace {

void setColor(cairo_t* cairo, const FigureColor& color) {
  cairo_set_source_rgba(cairo, color.red, color.green, color.blue, color.alpha);
}

void clipTo(cairo_t* cairo, const std::optional<FigureBox>& box) {
  if (!box) return;
  cairo_rectangle(cairo, box->x, box->y, box->width, box->height);
  cairo_clip(cairo);
}

void trace(cairo_t* cairo, const std::vector<FigurePoint>& points, bool closed) {
  for (const FigurePoint& p : points) cairo_line_to(cairo, p.x, p.y);
  if (closed) cairo_close_path(cairo);
}

void draw(cairo_t* cairo, const FigureLine& line) {
  clipTo(cairo, line.clip);
  setColor(cairo, line.color);
  cairo_set_line_width(cairo, line.width);
  cairo_set_line_join(cairo, line.closed ? CAIRO_LINE_JOIN_MITER : CAIRO_LINE_JOIN_ROUND);
  const double dashes[] = {3, 2};
  if (line.dashed) cairo_set_dash(cairo, dashes, 2, 0);
  trace(cairo, line.points, line.closed);
  cairo_stroke(cairo);
}

void draw(cairo_t* cairo, const FigureArea& area) {
  clipTo(cairo, area.clip);
  setColor(cairo, area.color);
  trace(cairo, area.points, true);
  cairo_fill(cairo);
}

void draw(cairo_t* cairo, const FigureDisk& disk) {
  setColor(cairo, disk.color);
  cairo_arc(cairo, disk.centre.x, disk.centre.y, disk.radius, 0, 2 * std::numbers::pi);
  cairo_fill(cairo);
}

void draw(cairo_t* cairo, const FigureText& text) {
  cairo_select_font_face(cairo, "Helvetica", CAIRO_FONT_SLANT_NORMAL,
                         text.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, text.size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, text.text.c_str(), &extents);
  const double before = text.anchor == FigureText::Anchor::kStart    ? 0
                        : text.anchor == FigureText::Anchor::kMiddle ? extents.x_advance / 2
                                                                     : extents.x_advance;
  setColor(cairo, text.color);
  cairo_translate(cairo, text.at.x, text.at.y);
  if (text.upwards) cairo_rotate(cairo, -std::numbers::pi / 2);
  cairo_move_to(cairo, -before, 0);
  cairo_show_text(cairo, text.text.c_str());
}

void draw(cairo_t* cairo, const FigurePicture& picture) {
  using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
  const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height),
                      cairo_surface_destroy);
  unsigned char* const rows = cairo_image_surface_get_data(image.get());
  if (!rows) throw std::runtime_error("no memory for a picture");
  const int stride = cairo_image_surface_get_stride(image.get());
  const std::uint8_t* from = picture.srgb.data();
  for (int y = 0; y < picture.height; ++y) {
    auto* const row =
        reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < picture.width; ++x, from += 3)
      row[x] = static_cast<std::uint32_t>(from[0] << 16 | from[1] << 8 | from[2]);
  }
  cairo_surface_mark_dirty(image.get());
  cairo_translate(cairo, picture.box.x, picture.box.y);
  cairo_scale(cairo, picture.box.width / picture.width, picture.box.height / picture.height);
  cairo_set_source_surface(cairo, image.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
  cairo_rectangle(cairo, 0, 0, picture.width, picture.height);
  cairo_fill(cairo);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

extern "C" void h2mcFigureFile(const Figure& figure, FigureFormat format, std::string& bytes) {
  cairo_surface_t* const surface =
      format == FigureFormat::kPdf
          ? cairo_pdf_surface_create_for_stream(append, &bytes, figure.width, figure.height)
          : cairo_svg_surface_create_for_stream(append, &bytes, figure.width, figure.height);
  cairo_t* const cairo = cairo_create(surface);
  for (const FigureShape& shape : figure.shapes) {
    cairo_save(cairo);
    cairo_new_path(cairo);  // text leaves a point
    std::visit([cairo](const auto& s) { draw(cairo, s); }, shape);
    cairo_restore(cairo);
  }
  cairo_status_t status = cairo_status(cairo);
  cairo_destroy(cairo);
  cairo_surface_finish(surface);
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
}

}  // namespace h2mc
