// SPDX-License-Identifier: MIT
// Eigenvalues and eigenvectors of small symmetric matrices, in double.
//
// Householder reflections reduce A to a tridiagonal T = V A V^T, then shifted QR steps with implicit
// shifts diagonalise T while their rotations are applied to the rows of V. See Golub and Van Loan,
// "Matrix Computations", sections 8.3.1 to 8.3.3.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "ad/dual_layout.h"

namespace h2mc::ad {

/// The eigendecomposition of symmetric matrices of up to MaxSize rows. Nothing is allocated; an
/// object of MaxSize 34 is 11 KB, and compute needs as much again of the stack.
template <int MaxSize = 34>
class SymmetricEigen {
 public:
  /// Numbers from one row of vectors() to the next.
  static constexpr int kStride = detail::divideUp(MaxSize, 8) * 8;

  /// Decomposes the n x n matrix whose entry (i, j), j <= i, is a[i * stride + j]; only that
  /// triangle is read. 1 <= n <= MaxSize. False if it has entries that are not finite, or if the
  /// iteration does not converge (not seen so far); then there is no result.
  bool compute(const double* a, int stride, int n);

  int size() const { return n_; }
  /// Eigenvalue k, in no particular order.
  double value(int k) const { return values_[k]; }
  /// The eigenvector of value(k), of length 1: size() numbers, then zeros to the next multiple of 8.
  const double* vector(int k) const { return vectors_[k]; }

 private:
  static constexpr int kWidth = detail::kRegisterBytes / int(sizeof(double));
  using Vec = typename detail::VectorOf<double, kWidth>::type;
  using Row = double[kStride];
  // Relative to a matrix with entries of order 1: squares of larger numbers do not underflow.
  static constexpr double kTiny = 1e-140;
  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

  static H2MC_AD_INLINE Vec load(const double* p) {
    Vec x;
    std::memcpy(&x, p, sizeof x);
    return x;
  }
  static H2MC_AD_INLINE void store(double* p, const Vec& x) { std::memcpy(p, &x, sizeof x); }
  static H2MC_AD_INLINE double sum(const Vec& x) {
    double s[kWidth];
    std::memcpy(s, &x, sizeof x);
    for (int half = kWidth / 2; half > 0; half /= 2)
      for (int i = 0; i < half; ++i) s[i] += s[i + half];
    return s[0];
  }

  void solve2(double a, double b, double c);
  void tridiagonalise(Row* a, double* offDiagonal);
  bool diagonalise(double* offDiagonal);

  alignas(64) double vectors_[MaxSize][kStride];
  double values_[MaxSize];
  int n_ = 0;
};

template <int MaxSize>
bool SymmetricEigen<MaxSize>::compute(const double* a, int stride, int n) {
  n_ = n;
  double largest = 0, finite = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double x = a[i * stride + j];
      largest = std::max(largest, std::abs(x));
      finite += x - x;
    }
  if (!(finite == 0)) return false;
  for (int i = 0; i < n; ++i) {
    std::fill_n(vectors_[i], kStride, 0.0);
    vectors_[i][i] = 1;
    values_[i] = 0;
  }
  if (largest == 0) return true;

  // Scaling by a power of two, exactly, so that no square over- or underflows.
  const int biased = int(std::bit_cast<std::uint64_t>(largest) >> 52);
  const int exponent = std::clamp(biased - 1023, -1000, 1000);
  const auto powerOfTwo = [](int e) {
    return std::bit_cast<double>(std::uint64_t(e + 1023) << 52);
  };
  const double down = powerOfTwo(-exponent), up = powerOfTwo(exponent);
  if (n == 1) {
    values_[0] = a[0];
    return true;
  }
  if (n == 2) {
    solve2(a[0] * down, a[stride] * down, a[stride + 1] * down);
  } else {
    alignas(64) double work[MaxSize][kStride];
    double offDiagonal[MaxSize];
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) work[i][j] = work[j][i] = a[i * stride + j] * down;
      std::fill(work[i] + n, work[i] + kStride, 0.0);
    }
    tridiagonalise(work, offDiagonal);
    if (!diagonalise(offDiagonal)) return false;
  }
  for (int i = 0; i < n; ++i) values_[i] *= up;
  return true;
}

// The rotation that makes [[a, b], [b, c]] diagonal, by the smaller of its two angles.
template <int MaxSize>
void SymmetricEigen<MaxSize>::solve2(double a, double b, double c) {
  double tangent = 0;
  if (b != 0) {
    const double theta = (c - a) / (2 * b);  // cot of twice the angle
    tangent = std::copysign(1 / (std::abs(theta) + std::sqrt(theta * theta + 1)), theta);
  }
  const double cosine = 1 / std::sqrt(tangent * tangent + 1), sine = tangent * cosine;
  values_[0] = a - tangent * b;
  values_[1] = c + tangent * b;
  vectors_[0][0] = vectors_[1][1] = cosine;
  vectors_[0][1] = -sine;
  vectors_[1][0] = sine;
}

// Makes values_ the diagonal of T, offDiagonal what is beside it, and applies the reflections to
// vectors_. The matrix is kept in full, so that products with it go along rows.
template <int MaxSize>
void SymmetricEigen<MaxSize>::tridiagonalise(Row* a, double* offDiagonal) {
  const int n = n_, chunks = detail::divideUp(n, kWidth);
  constexpr int kChunks = kStride / kWidth;
  for (int k = 0; k + 2 < n; ++k) {
    values_[k] = a[k][k];
    // Row k right of the diagonal becomes the reflection I - tau v v^T that maps it onto its first
    // coordinate. Left of that there are zeros; what other rows hold there is not used again.
    double* v = a[k];
    const double first = v[k + 1];
    std::fill_n(v, k + 2, 0.0);
    const int begin = (k + 1) / kWidth;
    Vec squares{};
    for (int c = begin; c < chunks; ++c) squares += load(v + c * kWidth) * load(v + c * kWidth);
    const double tail = sum(squares);
    if (tail < kTiny * kTiny) {
      offDiagonal[k] = first;
      continue;
    }
    const double norm = std::sqrt(first * first + tail);
    const double tau = 1 / (norm * (norm + std::abs(first)));  // 2 / v^T v
    offDiagonal[k] = -std::copysign(norm, first);
    v[k + 1] = first - offDiagonal[k];

    // p = tau A v and q = tau V^T v
    Vec p[kChunks] = {}, q[kChunks] = {};
    for (int r = k + 1; r < n; ++r) {
      const double t = tau * v[r];
      for (int c = begin; c < chunks; ++c) p[c] += t * load(a[r] + c * kWidth);
      for (int c = 0; c < chunks; ++c) q[c] += t * load(vectors_[r] + c * kWidth);
    }
    // A -= v w^T + w v^T with w = p - (tau p^T v / 2) v, and V -= v q^T
    Vec product{};
    for (int c = begin; c < chunks; ++c) product += p[c] * load(v + c * kWidth);
    const double half = 0.5 * tau * sum(product);
    alignas(64) double w[kStride];
    for (int c = begin; c < chunks; ++c) {
      p[c] -= half * load(v + c * kWidth);
      store(w + c * kWidth, p[c]);
    }
    for (int r = k + 1; r < n; ++r) {
      const double vr = v[r], wr = w[r];
      for (int c = begin; c < chunks; ++c)
        store(a[r] + c * kWidth, load(a[r] + c * kWidth) - vr * p[c] - wr * load(v + c * kWidth));
      for (int c = 0; c < chunks; ++c)
        store(vectors_[r] + c * kWidth, load(vectors_[r] + c * kWidth) - vr * q[c]);
    }
  }
  values_[n - 2] = a[n - 2][n - 2];
  values_[n - 1] = a[n - 1][n - 1];
  offDiagonal[n - 2] = a[n - 2][n - 1];
}

// QR steps on the tridiagonal matrix (values_, offDiagonal), from the last row up.
template <int MaxSize>
bool SymmetricEigen<MaxSize>::diagonalise(double* e) {
  double* d = values_;
  const int chunks = detail::divideUp(n_, kWidth);
  const auto negligible = [&](int i) {
    const double x = std::abs(e[i]);
    return x <= kEpsilon * (std::abs(d[i]) + std::abs(d[i + 1])) || x < kTiny;
  };
  const auto rotate = [&](int k, double c, double s) {  // rows k and k + 1 of the vectors
    for (int i = 0; i < chunks; ++i) {
      double *upper = vectors_[k] + i * kWidth, *lower = vectors_[k + 1] + i * kWidth;
      const Vec u = load(upper), l = load(lower);
      store(upper, c * u + s * l);
      store(lower, c * l - s * u);
    }
  };
  int steps = 30 * n_;
  for (int last = n_ - 1; last > 0;) {
    if (negligible(last - 1)) {
      --last;
      continue;
    }
    if (steps-- == 0) return false;
    int begin = last - 1;
    while (begin > 0 && !negligible(begin - 1)) --begin;

    // The last 2 x 2 block's rotation to diagonal form, by its tangent.
    const double b = e[last - 1], delta = 0.5 * (d[last - 1] - d[last]);
    const double tangent = b / (delta + std::copysign(std::sqrt(delta * delta + b * b), delta));
    const double shift = d[last] - tangent * b;  // Wilkinson's: its eigenvalue nearer to d[last]
    const double fill = last - 1 > begin ? tangent * e[last - 2] : 0;
    if (std::abs(fill) <= kEpsilon * (std::abs(d[last - 2 * (fill != 0)]) + std::abs(shift))) {
      // That rotation moves nothing of note to where the matrix has a zero: no step is needed.
      const double c = 1 / std::sqrt(1 + tangent * tangent);
      d[last - 1] += tangent * b;
      d[last] = shift;
      e[last - 1] = 0;
      if (last - 1 > begin) e[last - 2] *= c;
      rotate(last - 1, c, tangent * c);
      --last;
      continue;
    }
    double x = d[begin] - shift, z = e[begin];
    for (int k = begin; k < last; ++k) {
      // The rotation of rows k and k + 1 that turns (x, z) to (r, 0) pushes the bulge z one down.
      // Square root and division do not wait for each other.
      const double r2 = x * x + z * z, r = std::sqrt(r2), inverse = r * (1 / r2);
      const bool turns = r2 > kTiny * kTiny;
      const double c = turns ? x * inverse : 1, s = turns ? z * inverse : 0;
      if (k > begin) e[k - 1] = turns ? r : 0;
      const double t = s * (d[k + 1] - d[k]) + 2 * c * e[k];
      d[k] += s * t;
      d[k + 1] -= s * t;
      x = e[k] = c * t - e[k];
      if (k + 1 < last) {
        z = s * e[k + 1];
        e[k + 1] *= c;
      }
      rotate(k, c, s);
    }
  }
  return true;
}

}  // namespace h2mc::ad
