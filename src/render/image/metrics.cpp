// SPDX-License-Identifier: MIT
#include "render/image/metrics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "render/image/color_encoding.h"
#include "render/image/flip.h"

namespace h2mc {
namespace {

constexpr double kOffset = 0.01;    // of the mean luminance, keeps dark pixels from dominating
constexpr double kTrimmed = 0.001;  // share of pixels that the trimmed metric leaves out

double luminanceOf(const Rgbf& c) { return 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z; }

bool isFinite(const Rgbf& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// a / b, and 0 / 0 = 0: both images black.
double ratio(double a, double b) { return a == 0 && b == 0 ? 0 : a / b; }

// Mean over pixels and channels of error(a, r).
template <class Error>
double meanOver(const Image& image, const Image& reference, Error error) {
  assert(image.pixels.size() == reference.pixels.size() && !image.pixels.empty());
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgbf &a = image.pixels[i], &r = reference.pixels[i];
    sum += error(a.x, r.x) + error(a.y, r.y) + error(a.z, r.z);
  }
  return sum / (3.0 * static_cast<double>(image.pixels.size()));
}

auto relativeSquare(const Image& reference) {
  const double m = meanLuminance(reference);
  return [offset = kOffset * m * m](double a, double r) {
    return ratio((a - r) * (a - r), r * r + offset);
  };
}

double mse(const Image& image, const Image& reference) {
  return meanOver(image, reference, [](double a, double r) { return (a - r) * (a - r); });
}

double rmse(const Image& image, const Image& reference) { return std::sqrt(mse(image, reference)); }

double relmse(const Image& image, const Image& reference) {
  return meanOver(image, reference, relativeSquare(reference));
}

// Mean over the pixels but the worst, of error(a, r) averaged over channels.
template <class Error>
double trimmedMean(const Image& image, const Image& reference, Error error) {
  std::vector<double> perPixel;
  perPixel.reserve(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgbf &a = image.pixels[i], &r = reference.pixels[i];
    const double e = (error(a.x, r.x) + error(a.y, r.y) + error(a.z, r.z)) / 3;
    if (!std::isfinite(e)) return e;  // never left out
    perPixel.push_back(e);
  }
  const std::size_t kept =
      perPixel.size() - static_cast<std::size_t>(kTrimmed * static_cast<double>(perPixel.size()));
  std::nth_element(perPixel.begin(), perPixel.begin() + static_cast<std::ptrdiff_t>(kept) - 1,
                   perPixel.end());
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += perPixel[i];
  return sum / static_cast<double>(kept);
}

double relmseTrimmed(const Image& image, const Image& reference) {
  return trimmedMean(image, reference, relativeSquare(reference));
}

double mseTrimmed(const Image& image, const Image& reference) {
  return trimmedMean(image, reference, [](double a, double r) { return (a - r) * (a - r); });
}

double hdrFlip(const Image& image, const Image& reference) { return HdrFlip(reference)(image); }

double mae(const Image& image, const Image& reference) {
  return meanOver(image, reference, [](double a, double r) { return std::abs(a - r); });
}

double mape(const Image& image, const Image& reference) {
  const double offset = kOffset * meanLuminance(reference);
  return meanOver(image, reference, [offset](double a, double r) {
    return ratio(std::abs(a - r), std::abs(r) + offset);
  });
}

double smape(const Image& image, const Image& reference) {
  return meanOver(image, reference, [](double a, double r) {
    return ratio(2 * std::abs(a - r), std::abs(a) + std::abs(r));
  });
}

double psnr(const Image& image, const Image& reference) {
  float peak = 0;
  for (const Rgbf& r : reference.pixels) peak = std::max({peak, r.x, r.y, r.z});
  return 10 * std::log10(static_cast<double>(peak) * peak / mse(image, reference));
}

constexpr std::array kMetrics{
    Metric{"relmse", "relative mean square error, mean(e^2 / (r^2 + 0.01 m^2))", false, relmse},
    Metric{"relmse-trimmed", "relmse without the worst 0.1 % of the pixels", false, relmseTrimmed},
    Metric{"mse", "mean square error, mean(e^2)", false, mse},
    Metric{"mse-trimmed", "mse without the worst 0.1 % of the pixels", false, mseTrimmed},
    Metric{"rmse", "root mean square error, sqrt(mse)", false, rmse},
    Metric{"mae", "mean absolute error, mean(|e|)", false, mae},
    Metric{"mape", "mean absolute relative error, mean(|e| / (|r| + 0.01 m))", false, mape},
    Metric{"smape", "symmetric relative error, mean(2 |e| / (|a| + |r|))", false, smape},
    Metric{"hdr-flip", "HDR-FLIP, how different they look, 0 to 1 [Andersson et al. 2021]", false,
           hdrFlip},
    Metric{"psnr", "peak signal to noise ratio in dB, 10 log10(max(r)^2 / mse)", true, psnr},
};

Rgbf fromSrgb(double r, double g, double b) {
  const auto decode = [](double v) {
    return srgbToLinear(static_cast<float>(std::clamp(v, 0.0, 1.0)));
  };
  return {decode(r), decode(g), decode(b)};
}

// Black, then red (brighter) or blue (darker), then yellow or cyan.
Rgbf signedColor(double e) {
  const double strength = std::sqrt(std::min(std::abs(e), 1.0));
  const double first = std::min(1.6 * strength, 1.0), second = std::max(0.0, 2.5 * strength - 1.5);
  return e > 0 ? fromSrgb(first, second, 0) : fromSrgb(0, second, first);
}

// From black over purple and orange to pale yellow, t in [0, 1].
Rgbf heatColor(double t) {
  constexpr double stops[][3] = {
      {0, 0, 0.05}, {0.35, 0.05, 0.5}, {0.85, 0.2, 0.3}, {1, 0.6, 0.1}, {1, 1, 0.75}};
  constexpr int last = std::size(stops) - 1;
  const double position = std::clamp(t, 0.0, 1.0) * last;
  const int i = std::min(static_cast<int>(position), last - 1);
  const double f = position - i;
  const auto mix = [&](int c) { return stops[i][c] + f * (stops[i + 1][c] - stops[i][c]); };
  return fromSrgb(mix(0), mix(1), mix(2));
}

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

const Metric* findMetric(std::string_view name) {
  for (const Metric& metric : kMetrics)
    if (metric.name == name) return &metric;
  return nullptr;
}

double meanLuminance(const Image& image) {
  double sum = 0;
  for (const Rgbf& p : image.pixels) sum += luminanceOf(p);
  return sum / static_cast<double>(image.pixels.size());
}

long long countNonFinite(const Image& image) {
  return std::count_if(image.pixels.begin(), image.pixels.end(),
                       [](const Rgbf& p) { return !isFinite(p); });
}

Image differencePicture(const Image& image, const Image& reference, DifferencePicture kind) {
  assert(image.width == reference.width && image.height == reference.height);
  // The mean of what is finite, so that one bad pixel does not hide the others.
  double sum = 0;
  long long count = 0;
  for (const Rgbf& r : reference.pixels)
    if (isFinite(r)) {
      sum += luminanceOf(r);
      ++count;
    }
  const double offset = count > 0 ? kOffset * std::abs(sum) / static_cast<double>(count) : 0;

  Image picture(image.width, image.height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const Rgbf &a = image.pixels[i], &r = reference.pixels[i];
    if (!isFinite(a) || !isFinite(r)) {
      picture.pixels[i] = Rgbf(1, 0, 1);
      continue;
    }
    const double e = ratio(luminanceOf(a) - luminanceOf(r), std::abs(luminanceOf(r)) + offset);
    picture.pixels[i] = kind == DifferencePicture::kSigned
                            ? signedColor(e)
                            : heatColor(1 + std::log10(std::max(std::abs(e), 1e-4)) / 3);
  }
  return picture;
}

}  // namespace h2mc
