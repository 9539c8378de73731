// SPDX-License-Identifier: MIT
// Sampling of tabulated densities.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/core/safe_math.h"
#include "render/core/types.h"

namespace h2mc {

// Chooses among finitely many outcomes with probabilities proportional to given weights.
class DiscreteDistribution {
 public:
  DiscreteDistribution() = default;
  // weights: finite, not negative. All zero counts as all equal.
  explicit DiscreteDistribution(std::span<const double> weights);

  struct Sample {
    int index;
    float remainder;  // the coordinate within the outcome's interval, in [0, 1): uniform again
  };
  // Never an outcome of weight zero (unless all are). Precondition: size() > 0, 0 <= u < 1.
  Sample sample(float u) const;
  // A coordinate with which sample() gives `index` and about this remainder; -1 where the outcome's
  // interval is so narrow that no float lies in it.
  float invert(int index, float remainder) const;

  double probability(int index) const {
    const auto i = static_cast<std::size_t>(index);
    return cumulative_[i + 1] - cumulative_[i];
  }
  int size() const { return cumulative_.empty() ? 0 : static_cast<int>(cumulative_.size()) - 1; }

 private:
  std::vector<double> cumulative_;  // size() + 1 values from 0 to 1
};

// Maps u in [0,1) to x in [0,1] with density proportional to a + (b - a) x; a, b >= 0, not both 0.
// Derivatives stay finite where the density vanishes at one end.
template <class T>
T sampleLinear(const T& a, const T& b, const T& u) {
  using S = Scalar<T>;
  const S tiny = S(1e-12);
  if (value(u) < tiny) return sampleLinear<T>(a, b, T(tiny));
  const T root = safeSqrt(T(a * a + (b * b - a * a) * u));
  return u * (a + b) / (a + root);
}
// The same with a density that does not depend on the coordinates.
template <class T>
requires(ad::isDual<T>) T sampleLinear(Scalar<T> a, Scalar<T> b, const T& u) {
  using S = Scalar<T>;
  if (a == b) return u;
  const S tiny = S(1e-12);
  if (value(u) < tiny) return T(sampleLinear<S>(a, b, tiny));
  return u * (a + b) / (safeSqrt(T(u * (b * b - a * a) + a * a)) + a);
}
// The inverse.
inline double invertLinear(double a, double b, double x) {
  return x * (2 * a + (b - a) * x) / (a + b);
}

// A density on [0,1)^2 that is bilinear between the centres of the pixels of a map, periodic in u,
// and falls linearly to zero from the first and last row of pixel centres to v = 0 and v = 1: what
// an environment map's luminance times sin(theta) looks like.
class BilinearDistribution {
 public:
  // A cell between four nodes: column, row. Row 0 lies above the first row of pixel centres, row
  // `height` below the last.
  struct Cell {
    int column, row;
  };
  // A point of the unit square in terms of its cell.
  template <class T>
  struct Point {
    Cell cell;
    T x, y;  // within the cell, in [0, 1]
    T u, v;  // u may exceed 1 by half a pixel
    T pdf;   // density in (u, v)
  };

  BilinearDistribution() = default;
  // weights: one a pixel, row by row, positive and finite.
  BilinearDistribution(int width, int height, std::vector<float> weights);

  // Maps (u0, u1) uniform in [0,1)^2 to a point with this density. The cell is chosen by value; the
  // map is continuous from cell to cell, and from u0 = 1 to u0 = 0.
  template <class T>
  Point<T> sample(const T& u0, const T& u1) const;

  // The point at (u, v) in [0,1]^2.
  template <class T>
  Point<T> at(const T& u, const T& v) const;

  // What the density is bilinear between in a cell; along the cells at v = 0 and v = 1 it falls to 0 besides.
  struct Densities {
    double d00, d10, d01, d11;  // d[x][y]
  };
  Densities densities(const Cell& cell) const {
    const Rows rows = rowsOf(cell.row);
    const auto at = [&](std::size_t row, int column) {
      return static_cast<double>(weight(row, column)) / total_;
    };
    return {at(rows.first, cell.column), at(rows.first, cell.column + 1),
            at(rows.second, cell.column), at(rows.second, cell.column + 1)};
  }

  // Coordinates (u0, u1) with which sample() gives (u, v).
  Vec2f invert(double u, double v) const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  // Rows of pixels between which the density of u is interpolated: the same one twice in the cells
  // at v = 0 and v = 1, where only the height of the density changes.
  struct Rows {
    std::size_t first, second;
  };
  Rows rowsOf(int row) const {
    const int last = height_ - 1;
    return {static_cast<std::size_t>(row == 0 ? 0 : row - 1),
            static_cast<std::size_t>(row > last ? last : row)};
  }
  double rowStart(int row) const { return row == 0 ? 0.0 : (row - 0.5) / height_; }
  double rowExtent(int row) const { return (row == 0 || row == height_ ? 0.5 : 1.0) / height_; }
  double mass(std::size_t row) const { return cumulative_[row * stride() + stride() - 1]; }
  double nodeMass(int node) const {
    return node == 0 || node > height_ ? 0.0 : mass(static_cast<std::size_t>(node - 1));
  }
  double cumulative(std::size_t row, int column) const {
    return cumulative_[row * stride() + static_cast<std::size_t>(column)];
  }
  float weight(std::size_t row, int column) const {
    const int wrapped = column == width_ ? 0 : column;
    return weights_[row * static_cast<std::size_t>(width_) + static_cast<std::size_t>(wrapped)];
  }
  std::size_t stride() const { return static_cast<std::size_t>(width_) + 1; }
  // The column whose interval contains `target`, with rows interpolated at y.
  int findColumn(Rows rows, double y, double target) const;
  int findRow(double target) const;
  // Height of the density, relative to its rows, in the cells at v = 0 and v = 1.
  template <class T>
  T poleFactor(int row, const T& y) const {
    using S = Scalar<T>;
    if (row == 0) return y;
    if (row == height_) return ad::max(T(S(1) - y), T(S(1e-6)));
    return T(S(1));
  }
  template <class T>
  T interpolatedWeight(const Cell& cell, const Rows& rows, const T& x, const T& y) const;

  int width_ = 0, height_ = 0;
  double total_ = 0;                // integral of the weights over the unit square
  std::vector<float> weights_;      // height x width
  std::vector<double> cumulative_;  // height x (width + 1): integral over u from the first centre
  std::vector<double> rowCumulative_;  // height + 2: integral over v
};

template <class T>
T BilinearDistribution::interpolatedWeight(const Cell& cell, const Rows& rows, const T& x,
                                           const T& y) const {
  using S = Scalar<T>;
  const S w00 = weight(rows.first, cell.column), w10 = weight(rows.first, cell.column + 1);
  const S w01 = weight(rows.second, cell.column), w11 = weight(rows.second, cell.column + 1);
  if (rows.first == rows.second) return x * (w10 - w00) + w00;
  return linear3(x, w10 - w00, y, w01 - w00, T(x * y), (w11 - w01) - (w10 - w00)) + w00;
}

template <class T>
BilinearDistribution::Point<T> BilinearDistribution::sample(const T& u0, const T& u1) const {
  using S = Scalar<T>;
  // Values in double, derivatives around them: where most of the mass is in few cells, the others'
  // intervals are too narrow for differences of floats.
  const double value0 = static_cast<double>(value(u0)), value1 = static_cast<double>(value(u1));
  const auto local = [](double x) { return S(x < 0 ? 0 : x < 1 ? x : 1); };
  const T d0 = u0 - value(u0), d1 = u1 - value(u1);  // value zero

  Point<T> p;
  const int row = findRow(value1 * total_);
  const double rowMass = rowCumulative_[static_cast<std::size_t>(row) + 1] -
                         rowCumulative_[static_cast<std::size_t>(row)];
  const T along =
      d1 * S(total_ / rowMass) +
      local((value1 * total_ - rowCumulative_[static_cast<std::size_t>(row)]) / rowMass);
  p.y = sampleLinear<T>(S(nodeMass(row)), S(nodeMass(row + 1)), along);

  const Rows rows = rowsOf(row);
  const double y = static_cast<double>(value(p.y));
  const double deltaMass = mass(rows.second) - mass(rows.first);
  const double massHere = mass(rows.first) + y * deltaMass;
  const int column = findColumn(rows, y, value0 * massHere);
  p.cell = {column, row};
  const double start = cumulative(rows.first, column);
  const double deltaStart = cumulative(rows.second, column) - start;
  const S w00 = weight(rows.first, column), w10 = weight(rows.first, column + 1);
  const S scale = S(width_);
  if (rows.first == rows.second) {
    const S cellMass = (w00 + w10) / (2 * scale);
    const T across = d0 * S(massHere / cellMass) + local((value0 * massHere - start) / cellMass);
    p.x = sampleLinear<T>(w00, w10, across);
  } else {
    // (u0 m(y) - C(y)) / (cell's mass at y), expanded about the values.
    const S w01 = weight(rows.second, column), w11 = weight(rows.second, column + 1);
    const T dy = p.y - value(p.y);
    const T a = p.y * (w01 - w00) + w00;
    const T b = p.y * (w11 - w10) + w10;
    const T cellMass = (a + b) * (S(0.5) / scale);
    const double across =
        local((value0 * massHere - start - y * deltaStart) / static_cast<double>(value(cellMass)));
    const T numerator =
        linear3(d0, S(massHere), dy, S(value0 * deltaMass - deltaStart), T(d0 * dy), S(deltaMass)) +
        S(across * static_cast<double>(value(cellMass)));
    p.x = sampleLinear<T>(a, b, T(numerator / cellMass));
  }
  p.u = (p.x + S(column + 0.5)) / scale;
  p.v = p.y * S(rowExtent(row)) + S(rowStart(row));
  p.pdf = interpolatedWeight(p.cell, rows, p.x, p.y) * poleFactor(row, p.y) * S(1 / total_);
  return p;
}

template <class T>
BilinearDistribution::Point<T> BilinearDistribution::at(const T& u, const T& v) const {
  using S = Scalar<T>;
  Point<T> p{{0, 0}, u, v, u, v, T(S(0))};
  // Column -1, left of the first centre, is the last one.
  const S shiftedU = value(u) * S(width_) - S(0.5);
  int column = static_cast<int>(std::floor(shiftedU));
  column = column < -1 ? -1 : column > width_ - 1 ? width_ - 1 : column;
  p.x = u * S(width_) - S(column + 0.5);
  p.cell.column = column < 0 ? width_ - 1 : column;
  int row = static_cast<int>(std::floor(value(v) * S(height_) + S(0.5)));
  row = row < 0 ? 0 : row > height_ ? height_ : row;
  p.cell.row = row;
  p.y = (v - S(rowStart(row))) * S(1 / rowExtent(row));
  const Rows rows = rowsOf(row);
  p.pdf = interpolatedWeight(p.cell, rows, p.x, p.y) * poleFactor(row, p.y) * S(1 / total_);
  return p;
}

}  // namespace h2mc
