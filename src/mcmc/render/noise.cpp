// SPDX-License-Identifier: MIT
#include "mcmc/render/noise.h"

#include <algorithm>
#include <cmath>

namespace h2mc {
namespace {

constexpr double kFloor = 0.1;
constexpr long long kMostPixels = 1 << 18;
// Of the cost that samples get, whatever the chains seem to need: what they have not found yet makes no noise.
constexpr double kMostOfCost = 0.9;

}  // namespace

int measuredRows(const FilmSettings& film) {
  const long long pixels = static_cast<long long>(film.width) * film.height;
  return static_cast<int>((pixels - 1) / kMostPixels) + 1;
}

Image TwoEstimates::mean() const {
  if (a.pixels.empty() || b.pixels.empty()) return a.pixels.empty() ? b : a;
  Image result = a;
  const auto share = static_cast<float>(samplesB / (samplesA + samplesB));
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] += (b.pixels[i] - a.pixels[i]) * share;
  return result;
}

std::vector<double> relativeWeights(const Image& sharp, const Image& noisy, int cellWidth,
                                    int cellHeight) {
  const int width = sharp.width, height = sharp.height;
  const int columns = (width + cellWidth - 1) / cellWidth;
  const auto cellOf = [&](int x, int y) {
    return static_cast<std::size_t>(y / cellHeight) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x / cellWidth);
  };
  std::vector<double> sum(cellOf(width - 1, height - 1) + 1, 0), count(sum.size(), 0);
  double total = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double value = luminance(noisy.at(x, y));
      sum[cellOf(x, y)] += value;
      count[cellOf(x, y)] += 1;
      total += value + static_cast<double>(luminance(sharp.at(x, y)));
    }
  const double floor = kFloor * total / (static_cast<double>(width) * height);
  std::vector<double> weights;
  weights.reserve(sharp.pixels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double value = luminance(sharp.at(x, y)) + sum[cellOf(x, y)] / count[cellOf(x, y)];
      const double scale = std::max(value, 0.) + floor;
      weights.push_back(scale > 0 ? 1 / squared(scale) : 0);
    }
  return weights;
}

double varianceOfOneSample(const TwoEstimates& estimates, const std::vector<double>& weights) {
  const Image &a = estimates.a, &b = estimates.b;
  if (a.pixels.empty() || b.pixels.empty() || !(estimates.samplesA > 0 && estimates.samplesB > 0))
    return 0;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] * squared(static_cast<double>(luminance(a.pixels[i] - b.pixels[i])));
  return sum / static_cast<double>(weights.size()) /
         (1 / estimates.samplesA + 1 / estimates.samplesB);
}

double samplesAMutation(double perSample, double sampleCost, double perMutation,
                        double mutationCost) {
  const double most = kMostOfCost / (1 - kMostOfCost) * mutationCost / sampleCost;
  if (!(perSample > 0)) return 0;
  if (!(perMutation > 0)) return most;
  return std::min(most, std::sqrt(perSample / perMutation * mutationCost / sampleCost));
}

}  // namespace h2mc
