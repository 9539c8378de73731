// SPDX-License-Identifier: MIT
#include "render/core/distribution.h"

#include <algorithm>
#include <cmath>

#include "render/core/unit_interval.h"

namespace h2mc {

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
  if (weights.empty()) return;
  cumulative_.reserve(weights.size() + 1);
  cumulative_.push_back(0);
  double sum = 0;
  for (const double w : weights) cumulative_.push_back(sum += w);
  if (!(sum > 0)) {
    for (std::size_t i = 0; i < cumulative_.size(); ++i) cumulative_[i] = static_cast<double>(i);
    sum = static_cast<double>(weights.size());
  }
  for (double& c : cumulative_) c /= sum;
  cumulative_.back() = 1;
  // Nothing after the last outcome that can be chosen may begin below 1.
  for (std::size_t i = weights.size(); i-- > 0 && cumulative_[i] == cumulative_[i + 1];)
    cumulative_[i] = 1;
}

DiscreteDistribution::Sample DiscreteDistribution::sample(float u) const {
  // The last interval that starts at or before u; one of width zero never does so last.
  const auto next =
      std::upper_bound(cumulative_.begin(), cumulative_.end(), static_cast<double>(u));
  const auto i =
      static_cast<int>(std::clamp<std::ptrdiff_t>(next - cumulative_.begin() - 1, 0, size() - 1));
  const double remainder =
      (static_cast<double>(u) - cumulative_[static_cast<std::size_t>(i)]) / probability(i);
  return {i, toUnitInterval(remainder)};
}

float DiscreteDistribution::invert(int index, float remainder) const {
  const double start = cumulative_[static_cast<std::size_t>(index)];
  const auto u = static_cast<float>(start + static_cast<double>(remainder) * probability(index));
  for (const float candidate : {u, std::nextafter(u, 1.0f), std::nextafter(u, 0.0f)})
    if (candidate >= 0 && candidate < 1 && sample(candidate).index == index) return candidate;
  return -1;
}

BilinearDistribution::BilinearDistribution(int width, int height, std::vector<float> weights)
    : width_(width), height_(height), weights_(std::move(weights)) {
  cumulative_.resize(static_cast<std::size_t>(height) * stride());
  for (int row = 0; row < height; ++row) {
    const auto r = static_cast<std::size_t>(row);
    double sum = 0;
    for (int column = 0; column < width; ++column) {
      cumulative_[r * stride() + static_cast<std::size_t>(column)] = sum;
      sum += (static_cast<double>(weight(r, column)) + static_cast<double>(weight(r, column + 1))) /
             (2.0 * width);
    }
    cumulative_[r * stride() + static_cast<std::size_t>(width)] = sum;
  }
  rowCumulative_.resize(static_cast<std::size_t>(height) + 2);
  for (int row = 0; row <= height; ++row)
    rowCumulative_[static_cast<std::size_t>(row) + 1] =
        rowCumulative_[static_cast<std::size_t>(row)] +
        (nodeMass(row) + nodeMass(row + 1)) / 2 * rowExtent(row);
  total_ = rowCumulative_.back();
}

int BilinearDistribution::findRow(double target) const {
  const auto next = std::upper_bound(rowCumulative_.begin(), rowCumulative_.end(), target);
  return static_cast<int>(
      std::clamp<std::ptrdiff_t>(next - rowCumulative_.begin() - 1, 0, height_));
}

int BilinearDistribution::findColumn(Rows rows, double y, double target) const {
  const double* first = &cumulative_[rows.first * stride()];
  const double* second = &cumulative_[rows.second * stride()];
  int low = 0, high = width_;  // the interval that holds the target starts in [low, high)
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (first[middle] + y * (second[middle] - first[middle]) <= target)
      low = middle;
    else
      high = middle;
  }
  return low;
}

Vec2f BilinearDistribution::invert(double u, double v) const {
  const int row = std::clamp(static_cast<int>(std::floor(v * height_ + 0.5)), 0, height_);
  const double y = std::clamp((v - rowStart(row)) / rowExtent(row), 0.0, 1.0);
  const double rowMass = rowCumulative_[static_cast<std::size_t>(row) + 1] -
                         rowCumulative_[static_cast<std::size_t>(row)];
  const double u1 = (rowCumulative_[static_cast<std::size_t>(row)] +
                     rowMass * invertLinear(nodeMass(row), nodeMass(row + 1), y)) /
                    total_;

  const Rows rows = rowsOf(row);
  const auto blend = [y](double a, double b) { return a + y * (b - a); };
  double shifted = u * width_ - 0.5;
  shifted -= std::floor(shifted / width_) * width_;
  const int column = std::clamp(static_cast<int>(shifted), 0, width_ - 1);
  const double x = std::clamp(shifted - column, 0.0, 1.0);
  const double a = blend(weight(rows.first, column), weight(rows.second, column));
  const double b = blend(weight(rows.first, column + 1), weight(rows.second, column + 1));
  const double start = blend(cumulative(rows.first, column), cumulative(rows.second, column));
  const double u0 = (start + (a + b) / (2 * width_) * invertLinear(a, b, x)) /
                    blend(mass(rows.first), mass(rows.second));
  const auto coordinate = [](double c) { return toUnitInterval(c); };
  return {coordinate(u0), coordinate(u1)};
}

}  // namespace h2mc
