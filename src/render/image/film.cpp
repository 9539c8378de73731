#include "render/image/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace h2mc {
namespace {

// Steps of the filter's table: interpolation is then off by less than 1e-6 of the filter's peak.
constexpr int kTableSteps = 2048;

// The largest filter, in pixels each way: 2 * kMaxRadius + 2 weights fit on the stack.
constexpr int kMaxRadius = 64;

int pixelOf(float position, int size) {
  return std::clamp(static_cast<int>(position * static_cast<float>(size)), 0, size - 1);
}

}  // namespace

struct Film::Weights {
  int first = 0, count = 0;
  float values[2 * kMaxRadius + 2];
};

Film::Film(const FilmSettings& settings)
    : settings_(settings), pixels_(static_cast<std::size_t>(settings.width) * settings.height) {
  Filter& filter = settings_.filter;
  filter.radius = std::min(filter.radius, static_cast<float>(kMaxRadius));
  const bool box = filter.kind == Filter::Kind::kBox;
  // A narrower box would leave part of the film unseen: Mitsuba's smallest is a pixel.
  if (box) filter.radius = std::max(filter.radius, 0.5f);
  onePixel_ = box && filter.radius < 0.5f + 1e-3f;
  if (!box) {
    table_.resize(kTableSteps + 2);
    integral_.resize(kTableSteps + 2);
    for (int i = 0; i <= kTableSteps; ++i)
      table_[i] = filter.evaluate(filter.radius * static_cast<float>(i) / kTableSteps);
    table_[kTableSteps + 1] = 0;
    const double step = static_cast<double>(filter.radius) / kTableSteps;
    for (int i = 0; i <= kTableSteps; ++i)
      integral_[i + 1] =
          integral_[i] + 0.5 * step * (static_cast<double>(table_[i]) + table_[i + 1]);
  }
  normalX_ = normalisation(settings_.width);
  normalY_ = normalisation(settings_.height);
}

// Integral of the interpolated filter from `from` to `to`.
double Film::filterIntegral(double from, double to) const {
  const double radius = settings_.filter.radius;
  const auto primitive = [&](double x) {
    const double distance = std::min(std::abs(x), radius);
    double area = distance;  // box
    if (!table_.empty()) {
      const double position = distance / radius * kTableSteps;
      const int i = std::min(static_cast<int>(position), kTableSteps);
      const double f = position - i;
      const double step = radius / kTableSteps;
      area = integral_[i] + step * f * (table_[i] + 0.5 * f * (table_[i + 1] - table_[i]));
    }
    return x < 0 ? -area : area;
  };
  return primitive(to) - primitive(from);
}

std::vector<double> Film::normalisation(int size) const {
  std::vector<double> result(size, 1.0);
  if (onePixel_) return result;
  for (int i = 0; i < size; ++i) {
    const double centre = i + 0.5;
    result[i] = filterIntegral(0 - centre, size - centre);
  }
  return result;
}

Film::Weights Film::weights(double position, int size) const {
  const double radius = settings_.filter.radius;
  // Pixels whose centre is no further away than the radius.
  Weights w;
  w.first = std::max(0, static_cast<int>(std::ceil(position - radius - 0.5)));
  const int last = std::min(size - 1, static_cast<int>(std::floor(position + radius - 0.5)));
  w.count = last - w.first + 1;
  for (int i = 0; i < w.count; ++i) {
    const double distance = std::abs(w.first + i + 0.5 - position);
    if (table_.empty()) {
      w.values[i] = 1;
    } else {
      const double t = std::min(distance / radius, 1.0) * kTableSteps;
      const int k = static_cast<int>(t);
      const float f = static_cast<float>(t - k);
      w.values[i] = table_[k] + f * (table_[k + 1] - table_[k]);
    }
  }
  return w;
}

void Film::splat(float filmX, float filmY, const Rgbf& value) {
  assert(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z));
  const int width = settings_.width, height = settings_.height;
  if (onePixel_) {
    Accumulator& p =
        pixels_[static_cast<std::size_t>(pixelOf(filmY, height)) * width + pixelOf(filmX, width)];
    p.r += value.x;
    p.g += value.y;
    p.b += value.z;
    return;
  }
  const Weights wx = weights(static_cast<double>(filmX) * width, width);
  const Weights wy = weights(static_cast<double>(filmY) * height, height);
  for (int y = 0; y < wy.count; ++y) {
    Accumulator* row = &pixels_[static_cast<std::size_t>(wy.first + y) * width];
    for (int x = 0; x < wx.count; ++x) {
      const double w = static_cast<double>(wx.values[x]) * wy.values[y];
      Accumulator& p = row[wx.first + x];
      p.r += w * value.x;
      p.g += w * value.y;
      p.b += w * value.z;
    }
  }
}

void Film::merge(const Film& other) {
  assert(pixels_.size() == other.pixels_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    pixels_[i].r += other.pixels_[i].r;
    pixels_[i].g += other.pixels_[i].g;
    pixels_[i].b += other.pixels_[i].b;
  }
}

void Film::clear() { std::fill(pixels_.begin(), pixels_.end(), Accumulator{}); }

Image Film::develop(double scale) const {
  Image image(settings_.width, settings_.height);
  // The filter is in pixels: the film's area is width * height of them.
  const double area = static_cast<double>(settings_.width) * settings_.height;
  for (int y = 0; y < settings_.height; ++y)
    for (int x = 0; x < settings_.width; ++x) {
      const Accumulator& p = pixels_[static_cast<std::size_t>(y) * settings_.width + x];
      const double s = scale * area / (normalX_[x] * normalY_[y]);
      image.at(x, y) = Rgbf(static_cast<float>(p.r * s), static_cast<float>(p.g * s),
                            static_cast<float>(p.b * s));
    }
  return image;
}

}  // namespace h2mc
