// SPDX-License-Identifier: MIT
#include "compare/measure.h"

#include <fmt/format.h>

#include <cmath>

#include "render/image/flip.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

// Edge of the grid of blocks whose scatter tells the standard error of the squared bias.
constexpr int kBlocks = 8;

// In relmse.
struct Scatter {
  double squaredBias = 0, standardError = 0;
  double variance = 0;  // of the mean image
};

// With d_k = x_k - r: the sum of d_j d_k over j != k is (sum of d)^2 - sum of d^2, and its mean is
// n (n - 1) times the square of the bias, plus the reference's own squared error. Precondition:
// two images or more.
Scatter scatterOf(const std::vector<Image>& images, const std::vector<double>& factors,
                  const Image& reference) {
  const double n = static_cast<double>(images.size());
  const double m = meanLuminance(reference), offset = 0.01 * m * m;
  std::vector<double> block(kBlocks * kBlocks), size(kBlocks * kBlocks);
  Scatter result;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const std::size_t b = static_cast<std::size_t>(y * kBlocks / reference.height) * kBlocks +
                            static_cast<std::size_t>(x * kBlocks / reference.width);
      for (int c = 0; c < 3; ++c) {
        const double r = reference.at(x, y)[c];
        double sum = 0, squares = 0;
        for (std::size_t k = 0; k < images.size(); ++k) {
          const double d = factors[k] * images[k].at(x, y)[c] - r;
          sum += d;
          squares += d * d;
        }
        const double weight = 1 / (3 * (r * r + offset));
        if (!std::isfinite(weight)) continue;  // black on black
        block[b] += weight * (sum * sum - squares) / (n * (n - 1));
        result.variance += weight * (squares - sum * sum / n) / ((n - 1) * n);
      }
      size[b] += 1;
    }
  const double pixels = static_cast<double>(reference.pixels.size());
  result.variance /= pixels;
  std::vector<double> parts;  // each an estimate of the whole picture's
  for (std::size_t b = 0; b < block.size(); ++b) {
    if (size[b] > 0) parts.push_back(block[b] / size[b]);
    result.squaredBias += block[b] / pixels;
  }
  result.standardError = std::sqrt(sampleMoments(parts).varianceOfMean());
  return result;
}

}  // namespace

const std::vector<std::string>& comparedMetrics() {
  static const std::vector<std::string> names{"relmse", "relmse-trimmed", "mse",     "mse-trimmed",
                                              "mape",   "smape",          "hdr-flip"};
  return names;
}

bool measure(SceneRuns& runs, const Image& reference, const ComparisonObserver& observer) {
  const HdrFlip hdrFlip(reference);  // most of its work is the reference's
  const double brightness = meanLuminance(reference);
  double total = 0, done = 0;
  for (const MethodRuns& method : runs.methods)
    for (const Repeat& repeat : method.repeats) total += static_cast<double>(repeat.points.size());
  for (MethodRuns& method : runs.methods)
    for (Repeat& repeat : method.repeats)
      for (Point& point : repeat.points) {
        if (observer.stopped()) return false;
        const Image image = readImage(point.image.string());
        for (const std::string& name : comparedMetrics())
          point.errors[name] =
              name == "hdr-flip" ? hdrFlip(image) : findMetric(name)->compute(image, reference);
        point.meanRatio = meanLuminance(image) / brightness;
        done += 1;
        if (observer.status)
          observer.status(
              {fmt::format("errors of {}, image {:.0f} of {:.0f}", runs.scene.name, done, total), 0,
               0});
      }
  return true;
}

BiasCheck checkBias(const MethodRuns& method, const Image& reference, const ReferenceFacts& facts) {
  BiasCheck check;
  std::vector<Image> images;
  std::vector<double> ratios;
  for (const Repeat& repeat : method.repeats) {
    if (repeat.points.empty()) continue;
    images.push_back(readImage(repeat.points.back().image.string()));
    ratios.push_back(repeat.points.back().meanRatio);
  }
  check.meanRatio = meanEstimate(ratios);
  const std::size_t n = images.size();
  if (n == 0) return check;

  Image mean(reference.width, reference.height);
  for (const Image& image : images)
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
      mean.pixels[i] += image.pixels[i] / static_cast<float>(n);
  check.meanImageError = findMetric("relmse")->compute(mean, reference);
  if (n < 2) return check;

  const double slack = 3 * facts.brightness;
  check.brightnessOff = check.meanRatio.low - slack > 1 || check.meanRatio.high + slack < 1;
  const Scatter plain = scatterOf(images, std::vector<double>(n, 1.0), reference);
  check.varianceAlone = plain.variance + facts.error;
  check.squaredBias = plain.squaredBias - facts.error;
  check.standardError = plain.standardError;
  for (double& ratio : ratios) ratio = ratio > 0 ? 1 / ratio : 1;
  const Scatter scaled = scatterOf(images, ratios, reference);
  check.shows = scaled.squaredBias - facts.error > 3 * scaled.standardError;
  return check;
}

}  // namespace h2mc
