// SPDX-License-Identifier: MIT
#include "mcmc/targets/importance_map.h"

#include <algorithm>
#include <cmath>

#include "render/core/index.h"
namespace h2mc {
namespace {

// relMSE, by which renderers are compared, has the square of the same floor.
constexpr double kMapFloor = 0.1;

// [1 2 1] / 4 along rows of `length` numbers `stride` apart, the ends repeated.
void blurLines(std::vector<double>& values, int lines, int length, int lineStride, int stride) {
  std::vector<double> old(at(length));
  for (int line = 0; line < lines; ++line) {
    double* const first = values.data() + at(line) * at(lineStride);
    const auto value = [&](int i) -> double& { return first[at(i) * at(stride)]; };
    for (int i = 0; i < length; ++i) old[at(i)] = value(i);
    for (int i = 0; i < length; ++i) {
      const auto before = at(std::max(i - 1, 0)), after = at(std::min(i + 1, length - 1));
      value(i) = 0.25 * (old[before] + old[after]) + 0.5 * old[at(i)];
    }
  }
}

}  // namespace

ImportanceMap::ImportanceMap(const Image& picture, const Image& sampled, int cell)
    : columns_((picture.width + cell - 1) / cell),
      rows_((picture.height + cell - 1) / cell),
      perX_(static_cast<float>(picture.width) / static_cast<float>(cell)),
      perY_(static_cast<float>(picture.height) / static_cast<float>(cell)) {
  const auto cells = at(columns_) * static_cast<std::size_t>(rows_);
  std::vector<double> mean(cells, 0), count(cells, 0);
  double total = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto k =
          at(y / cell) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x / cell);
      const double value = std::max(0.f, luminance(picture.at(x, y)));
      mean[k] += value;
      count[k] += 1;
      total += value;
    }
  if (!(total > 0)) return;
  for (std::size_t k = 0; k < cells; ++k) mean[k] /= count[k];
  blurLines(mean, rows_, columns_, columns_, 1);
  blurLines(mean, columns_, rows_, 1, columns_);
  const double floor = kMapFloor * total / (static_cast<double>(picture.width) * picture.height);
  for (const double m : mean) values_.push_back(static_cast<float>(floor / (m + floor)));

  double plain = 0, weighted = 0;
  for (int y = 0; y < sampled.height; ++y)
    for (int x = 0; x < sampled.width; ++x) {
      const double value = std::max(0.f, luminance(sampled.at(x, y)));
      plain += value;
      weighted +=
          value * interpolate((static_cast<float>(x) + 0.5f) / static_cast<float>(sampled.width),
                              (static_cast<float>(y) + 0.5f) / static_cast<float>(sampled.height));
    }
  if (!(weighted > 0)) {
    values_.clear();
    return;
  }
  for (float& v : values_) v *= static_cast<float>(plain / weighted);
}

float ImportanceMap::interpolate(float filmX, float filmY) const {
  // Between the centres of the cells; beyond the outermost ones constant.
  const float x = std::clamp(filmX * perX_ - 0.5f, 0.f, static_cast<float>(columns_ - 1));
  const float y = std::clamp(filmY * perY_ - 0.5f, 0.f, static_cast<float>(rows_ - 1));
  const int i = std::min(static_cast<int>(x), std::max(columns_ - 2, 0));
  const int j = std::min(static_cast<int>(y), std::max(rows_ - 2, 0));
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const int right = columns_ > 1 ? 1 : 0, down = rows_ > 1 ? columns_ : 0;
  const float* v = &values_[at(j) * at(columns_) + static_cast<std::size_t>(i)];
  const float above = v[0] + fx * (v[right] - v[0]);
  const float below = v[down] + fx * (v[down + right] - v[down]);
  return above + fy * (below - above);
}

}  // namespace h2mc
