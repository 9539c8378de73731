// SPDX-License-Identifier: MIT
#include "ad/difference_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace h2mc::ad {
namespace {

// Halvings of a step along an axis, at most: from 1/16 down to 1e-11.
constexpr int kLevels = 34;
// Those that every entry gets, however noisy.
constexpr int kFewest = 4;
constexpr int kMixedLevels = 8;
// Standard deviations of noise that an estimate reckons with.
constexpr double kDeviations = 3;

// Richardson's tableau, row by row; keeps the entry of the smallest estimated error.
class Tableau {
 public:
  void push(double quotient, double noise) {
    ++rows_;
    if (!std::isfinite(quotient)) {
      previous_.clear();
      return;
    }
    row_.assign(1, {quotient, noise});
    double factor = 1;
    for (std::size_t i = 0; i < previous_.size() && i < kColumns; ++i) {
      factor *= 4;
      const Entry here = row_[i];  // copies: row_ grows below
      const Entry before = previous_[i];
      const Entry next{(here.value * factor - before.value) / (factor - 1),
                       (here.noise * factor + before.noise) / (factor - 1)};
      row_.push_back(next);
      const double error = std::max(
          {std::abs(next.value - here.value), std::abs(next.value - before.value), next.noise});
      if (error < best.error) {
        best = {next.value, error, next.noise};
        bestRow = rows_ - 1;
        bestColumn = static_cast<int>(i) + 1;
      }
    }
    previous_.swap(row_);
  }
  // Smaller steps only add noise.
  bool exhausted(double noise) const { return rows_ >= kFewest && noise > 2 * best.error; }

  Difference best;
  int bestRow = 0, bestColumn = 0;

 private:
  static constexpr std::size_t kColumns = 6;
  struct Entry {
    double value, noise;
  };
  std::vector<Entry> previous_, row_;
  int rows_ = 0;
};

class Sweep {
 public:
  Sweep(const PlainFunction& f, const double* x, int n, const double* largestStep, double stretch)
      : f_(f), x_(x), n_(n), at_(x, x + n), start_(static_cast<std::size_t>(n)) {
    for (int i = 0; i < n; ++i) {
      const double largest = largestStep[i];
      start_[index(i)] = largest > 0 ? stretch * std::exp2(std::floor(std::log2(largest))) : 0;
    }
    axes_.resize(static_cast<std::size_t>(n));
  }

  DifferenceSweep run() {
    DifferenceSweep result;
    result.value = center_ = f_(at_.data());
    noise_.resize(index(n_));
    for (int i = 0; i < n_; ++i) {
      noise_[index(i)] = measureNoise(i);
      result.noise = std::max(result.noise, noise_[index(i)]);
    }
    result.gradient.resize(static_cast<std::size_t>(n_));
    result.hessian.resize(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_ + 1) / 2);
    for (int i = 0; i < n_; ++i) sweepAxis(i, result);
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < i; ++j) sweepPair(i, j, result);
    return result;
  }

 private:
  struct Pair {
    double plus, minus;
  };
  struct Axis {
    std::array<std::optional<Pair>, kLevels> values;
    int begin = 0;  // where the second derivative's best estimate begins
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  double step(int i, int level) const { return std::ldexp(start_[index(i)], -level); }

  double moved(int i, double di, int j, double dj) {
    at_[index(i)] += di;
    at_[index(j)] += dj;
    const double y = f_(at_.data());
    at_[index(i)] = x_[i];
    at_[index(j)] = x_[j];
    return y;
  }
  const Pair& axis(int i, int level) {
    std::optional<Pair>& pair = axes_[index(i)].values[index(level)];
    if (!pair) {
      const double h = step(i, level);
      pair = {moved(i, h, i, 0), moved(i, -h, i, 0)};
    }
    return *pair;
  }

  // Along one axis, since moving the last coordinate of a long computation disturbs less of it than
  // moving the first: from points close together, inwards. Differences of an order that f's smooth
  // part no longer shows in are those of independent errors.
  double measureNoise(int i) {
    constexpr int kPoints = 10, kFirstOrder = 4, kLastOrder = 6;
    if (!(start_[index(i)] > 0)) return floorOfNoise();
    std::array<double, kPoints> table{};
    const double spacing = std::ldexp(x_[i] < 0.5 ? 1.0 : -1.0, -32);
    for (int k = 0; k < kPoints; ++k) {
      table[index(k)] = moved(i, k * spacing, i, 0);
      if (!std::isfinite(table[index(k)])) return floorOfNoise();
    }
    std::array<double, kLastOrder - kFirstOrder + 1> sigma{};
    double gamma = 1;  // (k!)^2 / (2k)!
    for (int order = 1; order <= kLastOrder; ++order) {
      double sum = 0;
      for (int k = 0; k + order < kPoints; ++k) {
        table[index(k)] = table[index(k + 1)] - table[index(k)];
        sum += table[index(k)] * table[index(k)];
      }
      gamma *= 0.5 * order / (2 * order - 1);
      if (order >= kFirstOrder)
        sigma[index(order - kFirstOrder)] = std::sqrt(gamma * sum / (kPoints - order));
    }
    std::sort(sigma.begin(), sigma.end());
    return std::max(sigma[1], floorOfNoise());
  }
  double floorOfNoise() const {
    return 0.5 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(center_));
  }

  void sweepAxis(int i, DifferenceSweep& result) {
    if (!(start_[index(i)] > 0)) return;
    Tableau first, second;
    for (int level = 0; level < kLevels; ++level) {
      const double h = step(i, level);
      const auto& [plus, minus] = axis(i, level);
      const double sigma = kDeviations * noise_[index(i)];
      const double noise1 = sigma * std::sqrt(0.5) / h, noise2 = sigma * std::sqrt(6.0) / (h * h);
      first.push((plus - minus) / (2 * h), noise1);
      second.push(((plus - center_) + (minus - center_)) / (h * h), noise2);
      if (second.exhausted(noise2) && first.exhausted(noise1)) break;
    }
    result.gradient[index(i)] = first.best;
    result.hessian[index(triangleIndex(i, i))] = second.best;
    axes_[index(i)].begin = std::max(0, second.bestRow - std::min(second.bestColumn, 3));
  }

  void sweepPair(int i, int j, DifferenceSweep& result) {
    if (!(start_[index(i)] > 0 && start_[index(j)] > 0)) return;
    Tableau mixed;
    for (int m = 0; m < kMixedLevels; ++m) {
      const int a = axes_[index(i)].begin + m, b = axes_[index(j)].begin + m;
      if (a >= kLevels || b >= kLevels) break;
      const double hi = step(i, a), hj = step(j, b);
      const Pair& pi = axis(i, a);
      const Pair& pj = axis(j, b);
      const double along = (moved(i, hi, j, hj) - center_) + (moved(i, -hi, j, -hj) - center_);
      const double quotient = (along - ((pi.plus - center_) + (pi.minus - center_)) -
                               ((pj.plus - center_) + (pj.minus - center_))) /
                              (2 * hi * hj);
      const double sigma = kDeviations * std::max(noise_[index(i)], noise_[index(j)]);
      const double noise = sigma * std::sqrt(10.0) / (2 * hi * hj);
      mixed.push(quotient, noise);
      if (mixed.exhausted(noise)) break;
    }
    result.hessian[index(triangleIndex(i, j))] = mixed.best;
  }

  const PlainFunction& f_;
  const double* x_;
  int n_;
  std::vector<double> at_, start_;
  std::vector<Axis> axes_;
  double center_ = 0;
  std::vector<double> noise_;
};

}  // namespace

DifferenceSweep differenceSweep(const PlainFunction& f, const double* x, int n,
                                const double* largestStep, double stretch) {
  return Sweep(f, x, n, largestStep, stretch).run();
}

std::vector<SweepPoint> sweepEntry(const PlainFunction& f, const double* x, int n, int i, int j,
                                   double largestStep, double ratio, int levels) {
  std::vector<double> at(x, x + n);
  const auto value = [&](double a, double b) {
    at[static_cast<std::size_t>(i)] += a;
    if (j >= 0) at[static_cast<std::size_t>(j)] += b;
    const double y = f(at.data());
    std::copy(x, x + n, at.begin());
    return y;
  };
  const double center = f(x);
  std::vector<SweepPoint> points;
  double h = std::exp2(std::floor(std::log2(largestStep)));
  for (int level = 0; level < levels; ++level, h *= 0.5) {
    double q;
    if (j < 0)
      q = (value(h, 0) - value(-h, 0)) / (2 * h);
    else if (i == j)
      q = ((value(h, 0) - center) + (value(-h, 0) - center)) / (h * h);
    else
      q = (value(h, ratio * h) - value(h, -ratio * h) - value(-h, ratio * h) +
           value(-h, -ratio * h)) /
          (4 * h * h * ratio);
    SweepPoint point{h, q, std::numeric_limits<double>::quiet_NaN()};
    const std::size_t k = points.size();
    if (k >= 2) {
      const double a = (4 * q - points[k - 1].quotient) / 3;
      const double b = (4 * points[k - 1].quotient - points[k - 2].quotient) / 3;
      point.extrapolated = (16 * a - b) / 15;
    }
    points.push_back(point);
  }
  return points;
}

bool kinkAt(const PlainFunction& f, const double* x, int n, const double* direction, double noise,
            double scale) {
  std::vector<double> at(static_cast<std::size_t>(n));
  const auto value = [&](double s) {
    for (int k = 0; k < n; ++k) at[static_cast<std::size_t>(k)] = x[k] + s * direction[k];
    return f(at.data());
  };
  const double center = f(x);
  double h = 1;
  double first = std::numeric_limits<double>::infinity(), second = first;
  for (int level = 0; level < kLevels; ++level, h *= 0.5) {
    const double rounding1 = kDeviations * noise * std::sqrt(2 * 26.0) / (2 * h);
    const double rounding2 = kDeviations * noise * std::sqrt(2 * 46.0) / (h * h);
    if (rounding1 > scale) break;
    const double a1 = value(h), a2 = value(2 * h), a3 = value(3 * h);
    const double b1 = value(-h), b2 = value(-2 * h), b3 = value(-3 * h);
    const double jump1 = (4 * (a1 + b1) - a2 - b2 - 6 * center) / (2 * h);
    const double jump2 = (5 * (b1 - a1) + 4 * (a2 - b2) + (b3 - a3)) / (h * h);
    if (std::isfinite(jump1)) first = std::min(first, std::abs(jump1) - rounding1);
    if (std::isfinite(jump2) && rounding2 <= scale)
      second = std::min(second, std::abs(jump2) - rounding2);
  }
  return !(first <= scale && second <= scale);
}

}  // namespace h2mc::ad
