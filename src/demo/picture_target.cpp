// SPDX-License-Identifier: MIT
#include "demo/picture_target.h"

#include <algorithm>
#include <cmath>

#include "ad/dual.h"
#include "ad/functions.h"
#include "render/core/types.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

// Weights of the four control points around a position; t in [0, 1] from the second to the third.
template <class T>
void splineWeights(const T& t, T (&w)[4]) {
  const T s = T(1.f) - t;
  w[0] = s * s * s * (1 / 6.f);
  w[1] = (t * t * (t * 3.f - 6.f) + 4.f) * (1 / 6.f);
  w[2] = (s * s * (s * 3.f - 6.f) + 4.f) * (1 / 6.f);
  w[3] = t * t * t * (1 / 6.f);
}

// The first of four control points, and the position between the middle ones.
int firstControl(float x, int size, float& t) {
  const float position = x * static_cast<float>(size) - 0.5f;
  const float below = std::floor(position);
  t = position - below;
  return static_cast<int>(below) - 1;
}

}  // namespace

PictureTarget::PictureTarget(const Image& picture) : picture_(picture) {
  const float floor = static_cast<float>(1e-3 * meanLuminance(picture));
  for (Rgbf& p : picture_.pixels)
    for (int c = 0; c < 3; ++c) p[c] = std::max(p[c], floor);
}

Rgbf PictureTarget::color(float x, float y) const {
  float tx, ty, wx[4], wy[4];
  const int x0 = firstControl(x, picture_.width, tx), y0 = firstControl(y, picture_.height, ty);
  splineWeights(tx, wx);
  splineWeights(ty, wy);
  Rgbf sum(0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += wx[i] * wy[j] *
             picture_.at(std::clamp(x0 + i, 0, picture_.width - 1),
                         std::clamp(y0 + j, 0, picture_.height - 1));
  return sum;
}

void PictureTarget::differentiate(float x, float y, Derivative& result) const {
  using D = ad::Dual2<float, 2>;
  float tx, ty;
  const int x0 = firstControl(x, picture_.width, tx), y0 = firstControl(y, picture_.height, ty);
  D wx[4], wy[4];
  // Derivatives with respect to pixels first.
  splineWeights(D::variable(tx, 0), wx);
  splineWeights(D::variable(ty, 1), wy);
  D sum(0.f);
  for (int j = 0; j < 4; ++j) {
    D row(0.f);
    for (int i = 0; i < 4; ++i)
      row = row + wx[i] * luminance(picture_.at(std::clamp(x0 + i, 0, picture_.width - 1),
                                                std::clamp(y0 + j, 0, picture_.height - 1)));
    sum = sum + row * wy[j];
  }
  const D f = ad::log(sum);
  const float scale[2] = {static_cast<float>(picture_.width), static_cast<float>(picture_.height)};
  result.dimension = 2;
  result.logTarget = f.v;
  for (int i = 0, k = 0; i < 2; ++i) {
    result.gradient[i] = f.gradient(i) * scale[i];
    for (int j = 0; j <= i; ++j, ++k) result.hessian[k] = f.hessian(i, j) * scale[i] * scale[j];
  }
}

Image PictureTarget::pixelMeans() const {
  constexpr int kPoints = 4;
  Image means(picture_.width, picture_.height);
  for (int y = 0; y < means.height; ++y)
    for (int x = 0; x < means.width; ++x)
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          means.at(x, y) +=
              color((static_cast<float>(x) + (static_cast<float>(i) + 0.5f) / kPoints) /
                        static_cast<float>(means.width),
                    (static_cast<float>(y) + (static_cast<float>(j) + 0.5f) / kPoints) /
                        static_cast<float>(means.height)) *
              (1.f / (kPoints * kPoints));
  return means;
}

Image shrunk(const Image& picture, int width) {
  if (picture.width <= width) return picture;
  const double factor = static_cast<double>(picture.width) / width;
  const int height = std::max(1, static_cast<int>(std::lround(picture.height / factor)));
  Image small(width, height);
  // Weights of the large picture's pixels under one of the small one's.
  const auto cover = [](int i, int size, int largeSize, auto&& visit) {
    const double from = static_cast<double>(i) * largeSize / size;
    const double to = static_cast<double>(i + 1) * largeSize / size;
    for (int k = static_cast<int>(from); k < largeSize && k < to; ++k)
      visit(k,
            static_cast<float>((std::min(k + 1.0, to) - std::max<double>(k, from)) / (to - from)));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      cover(y, height, picture.height, [&](int j, float wy) {
        cover(x, width, picture.width,
              [&](int i, float wx) { small.at(x, y) += picture.at(i, j) * (wx * wy); });
      });
  return small;
}

}  // namespace h2mc
