// SPDX-License-Identifier: MIT
#include "inspect/ridge.h"

#include <algorithm>
#include <cmath>

#include "inspect/slice.h"

namespace h2mc {
namespace {

// Of the square: so many times the ridge's width, so that it is some cells wide and there is room beside it, and no
// less than an isotropic step, which is to be seen in it.
constexpr double kWidths = 12, kSteps = 1.5;
constexpr double kMostHalf = 0.5;
// Of an isotropic step: a ridge's width below which most such steps miss it.
constexpr double kNarrow = 0.2;
constexpr int kResolution = 25;

// The longer axis of the target in the slice over the shorter, both as standard deviations of a density in proportion
// to it. A cell's own width, of which a narrower ridge would know nothing, is added.
double measuredRatio(const Slice& slice) {
  double sum = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (int row = 0; row < slice.resolution; ++row)
    for (int column = 0; column < slice.resolution; ++column) {
      const float logRatio = slice.logRatio[slice.index(column, row)];
      if (!std::isfinite(logRatio)) continue;
      const double weight = std::exp(double(logRatio));
      const double a = slice.x(column) / slice.halfX, b = slice.y(row) / slice.halfY;
      sum += weight;
      x += weight * a;
      y += weight * b;
      xx += weight * a * a;
      xy += weight * a * b;
      yy += weight * b * b;
    }
  if (!(sum > 0) || !std::isfinite(sum)) return 0;
  const double cell = 2.0 / slice.resolution, own = cell * cell / 12;
  const double varianceX = xx / sum - x * x / (sum * sum) + own;
  const double varianceY = yy / sum - y * y / (sum * sum) + own;
  const double covariance = xy / sum - x * y / (sum * sum);
  const double middle = (varianceX + varianceY) / 2;
  const double apart = std::hypot((varianceX - varianceY) / 2, covariance);
  return std::sqrt((middle + apart) / std::max(middle - apart, own));
}

}  // namespace

Ridge ridgeAt(const Scene& scene, const Path& path, const LocalModel& model, int threads,
              const std::atomic<bool>* stop) {
  const double step = model.settings.sigma;
  if (!model.available || model.eigen.size() < 2) return {0, std::min(4 * step, kMostHalf)};
  const EigenDirection &across = model.eigen[0], &along = model.eigen[1];
  const double width = 1 / std::sqrt(std::max(std::abs(across.value), 1e-12));
  Ridge ridge;
  ridge.half = std::clamp(kWidths * width, std::min(kSteps * step, kMostHalf), kMostHalf);
  if (!(across.value < 0)) return ridge;
  const double quadratic = std::sqrt(-across.value / std::max(std::abs(along.value), 1e-12));
  const Slice slice = traceSlice(scene, path, {"e1", across.vector}, {"e2", along.vector},
                                 ridge.half, ridge.half, kResolution, threads, stop);
  ridge.strength = std::min(quadratic, measuredRatio(slice)) *
                   std::min({1.0, std::sqrt(kWidths * width / ridge.half), kNarrow * step / width});
  return ridge;
}

}  // namespace h2mc
