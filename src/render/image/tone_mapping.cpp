// SPDX-License-Identifier: MIT
#include "render/image/tone_mapping.h"

#include <algorithm>
#include <cmath>

namespace h2mc {
namespace {

// The curve of the Academy Color Encoding System's reference rendering and Rec. 709 output transforms, as a ratio of
// polynomials that is fitted to it, channel by channel [Narkowicz, ACES Filmic Tone Mapping Curve, 2016; under CC0 or
// MIT]. Middle grey stays about where it is.
float filmic(float v) {
  const double x = v > 0 ? std::min(v, 1e6f) : 0.f;
  const double y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  return static_cast<float>(std::clamp(y, 0.0, 1.0));
}

}  // namespace

double autoExposure(const Image& image) {
  constexpr double kGrey = 0.18;
  double sum = 0, count = 0;
  for (const Rgbf& pixel : image.pixels) {
    const double l = luminance(Rgb<double>(pixel));
    if (!(l > 0 && std::isfinite(l))) continue;
    sum += std::log2(l);
    ++count;
  }
  return count > 0 ? std::log2(kGrey) - sum / count : 0;
}

Image toneMapped(const Image& image, const ToneMapping& mapping) {
  const double stops = mapping.stops ? *mapping.stops : autoExposure(image);
  Image result = image;
  if (stops != 0) {
    const double factor = std::exp2(stops);
    for (Rgbf& pixel : result.pixels) pixel = Rgbf(Rgb<double>(pixel) * factor);
  }
  if (mapping.curve == ToneCurve::kFilmic)
    for (Rgbf& p : result.pixels) p = {filmic(p.x), filmic(p.y), filmic(p.z)};
  return result;
}

}  // namespace h2mc
