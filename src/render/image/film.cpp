// SPDX-License-Identifier: MIT
#include "render/image/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/parallel.h"

namespace h2mc {
namespace {

// Steps of the filter's table: interpolation is then off by less than 1e-6 of the filter's peak.
constexpr int kTableSteps = 2048;

int pixelOf(float position, int size) {
  return std::clamp(static_cast<int>(position * static_cast<float>(size)), 0, size - 1);
}

}  // namespace

template <class Real>
struct BasicFilm<Real>::Weights {
  RowRange range;
  float values[2 * static_cast<int>(Filter::kWidest) + 2];
};

template <class Real>
BasicFilm<Real>::BasicFilm(const FilmSettings& settings) : BasicFilm(settings, 0) {}

template <class Real>
BasicFilm<Real>::BasicFilm(const FilmSettings& settings, int step)
    : settings_(settings), pixels_(pixelCount()), step_(step) {
  const Filter& filter = settings_.filter;
  assert(filter.radius >= Filter::kNarrowest && filter.radius <= Filter::kWidest);
  const bool box = filter.kind == Filter::Kind::kBox;
  onePixel_ = box && filter.radius < 0.5f + 1e-3f;
  if (!box) {
    table_.resize(kTableSteps + 2);
    integral_.resize(kTableSteps + 2);
    for (int i = 0; i <= kTableSteps; ++i)
      table_[i] = filter.evaluate(filter.radius * static_cast<float>(i) / kTableSteps);
    table_[kTableSteps + 1] = 0;
    const double spacing = static_cast<double>(filter.radius) / kTableSteps;
    for (int i = 0; i <= kTableSteps; ++i)
      integral_[i + 1] =
          integral_[i] + 0.5 * spacing * (static_cast<double>(table_[i]) + table_[i + 1]);
  }
  normalX_ = normalisation(settings_.width);
  normalY_ = normalisation(settings_.height);
  clearHalves();
}

// Integral of the interpolated filter from `from` to `to`.
template <class Real>
double BasicFilm<Real>::filterIntegral(double from, double to) const {
  const double radius = settings_.filter.radius;
  const auto primitive = [&](double x) {
    const double distance = std::min(std::abs(x), radius);
    double area = distance;  // box
    if (!table_.empty()) {
      const double position = distance / radius * kTableSteps;
      const int i = std::min(static_cast<int>(position), kTableSteps);
      const double f = position - i;
      const double spacing = radius / kTableSteps;
      area = integral_[i] + spacing * f * (table_[i] + 0.5 * f * (table_[i + 1] - table_[i]));
    }
    return x < 0 ? -area : area;
  };
  return primitive(to) - primitive(from);
}

template <class Real>
std::vector<double> BasicFilm<Real>::normalisation(int size) const {
  std::vector<double> result(size, 1.0);
  if (onePixel_) return result;
  for (int i = 0; i < size; ++i) {
    const double centre = i + 0.5;
    result[i] = filterIntegral(0 - centre, size - centre);
  }
  return result;
}

template <class Real>
RowRange BasicFilm<Real>::reach(double position, int size) const {
  const double radius = settings_.filter.radius;
  return {std::max(0, static_cast<int>(std::ceil(position - radius - 0.5))),
          std::min(size - 1, static_cast<int>(std::floor(position + radius - 0.5))) + 1};
}

template <class Real>
RowRange BasicFilm<Real>::rowsOf(float filmY) const {
  if (!onePixel_) return reach(static_cast<double>(filmY) * height(), height());
  const int row = pixelOf(filmY, height());
  return {row, row + 1};
}

template <class Real>
typename BasicFilm<Real>::Weights BasicFilm<Real>::weights(double position, RowRange range) const {
  const double radius = settings_.filter.radius;
  Weights w;
  w.range = range;
  for (int i = range.begin; i < range.end; ++i) {
    float& value = w.values[i - range.begin];
    if (table_.empty()) {
      value = 1;
    } else {
      const double t = std::min(std::abs(i + 0.5 - position) / radius, 1.0) * kTableSteps;
      const int k = static_cast<int>(t);
      const float f = static_cast<float>(t - k);
      value = table_[k] + f * (table_[k + 1] - table_[k]);
    }
  }
  return w;
}

template <class Real>
void BasicFilm<Real>::splat(float filmX, float filmY, const Rgbf& value, RowRange rows, int half) {
  assert(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z));
  const int width = settings_.width;
  if (onePixel_) {
    const int x = pixelOf(filmX, width), y = pixelOf(filmY, settings_.height);
    if (y < rows.begin || y >= rows.end) return;
    Accumulator& p = pixels_[at(y) * at(width) + at(x)];
    for (int c = 0; c < 3; ++c) p[at(c)] += static_cast<Real>(value[c]);
    if (step_ > 0 && y % step_ == 0) addToHalf(half, x, y, luminance(value));
    return;
  }
  const double positionX = static_cast<double>(filmX) * width;
  const double positionY = static_cast<double>(filmY) * settings_.height;
  RowRange inY = reach(positionY, settings_.height);
  inY = {std::max(inY.begin, rows.begin), std::min(inY.end, rows.end)};
  if (inY.begin >= inY.end) return;
  const Weights wx = weights(positionX, reach(positionX, width)), wy = weights(positionY, inY);
  for (int y = inY.begin; y < inY.end; ++y) {
    const bool measured = step_ > 0 && y % step_ == 0;
    for (int x = wx.range.begin; x < wx.range.end; ++x) {
      const double w =
          static_cast<double>(wx.values[x - wx.range.begin]) * wy.values[y - inY.begin];
      Accumulator& p = pixels_[at(y) * at(width) + at(x)];
      for (int c = 0; c < 3; ++c) p[at(c)] += static_cast<Real>(w * value[c]);
      if (measured) addToHalf(half, x, y, w * luminance(value));
    }
  }
}

template <class Real>
void BasicFilm<Real>::clear() {
  // A small one is soon overwritten; of a large one few pixels may have been touched.
  pixels_ = {};
  reserve();
}

template <class Real>
void BasicFilm<Real>::clearHalves() {
  if (step_ == 0) return;
  for (auto& half : halves_) half.assign(at((height() - 1) / step_ + 1) * at(width()), 0);
}

template <class Real>
void BasicFilm<Real>::release() {
  pixels_ = {};
}

template <class Real>
void BasicFilm<Real>::reserve() {
  pixels_ = ZeroedArray<Accumulator>(pixelCount());
}

template <class Real>
void BasicFilm<Real>::archive(Archive& archive) {
  const std::size_t sizes[] = {pixelCount(), halves_[0].size(), halves_[1].size()};
  archive(pixels_, halves_[0], halves_[1]);
  if ((pixels_.size() != 0 && pixels_.size() != sizes[0]) || halves_[0].size() != sizes[1] ||
      halves_[1].size() != sizes[2])
    throw ArchiveError("it has another number of pixels");
}

// What the sum in a pixel is to be multiplied with.
template <class Real>
double BasicFilm<Real>::factor(int x, int y, double scale) const {
  // The filter is in pixels: the film's area is width * height of them.
  return scale * settings_.width * settings_.height / (normalX_[at(x)] * normalY_[at(y)]);
}

template <class Real>
Rgbf BasicFilm<Real>::pixel(int x, int y, double scale) const {
  const Accumulator& p = pixels_[at(y) * at(settings_.width) + at(x)];
  const double s = factor(x, y, scale);
  return Rgbf(static_cast<float>(p[0] * s), static_cast<float>(p[1] * s),
              static_cast<float>(p[2] * s));
}

template <class Real>
Image BasicFilm<Real>::develop(double scale, int threads) const {
  Image image(settings_.width, settings_.height);
  parallelFor(threads, settings_.height, [&](int y) {
    for (int x = 0; x < settings_.width; ++x) image.at(x, y) = pixel(x, y, scale);
  });
  return image;
}

template <class Real>
Image BasicFilm<Real>::developHalf(int half, double scale) const {
  assert(step_ > 0);
  Image image(settings_.width, (settings_.height - 1) / step_ + 1);
  for (int row = 0; row < image.height; ++row)
    for (int x = 0; x < image.width; ++x) {
      const double sum = halves_[half][at(row) * at(image.width) + at(x)];
      image.at(x, row) = Rgbf(static_cast<float>(sum * factor(x, row * step_, scale)));
    }
  return image;
}

template class BasicFilm<double>;
template class BasicFilm<float>;

}  // namespace h2mc
