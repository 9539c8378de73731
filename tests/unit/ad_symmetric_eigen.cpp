// SPDX-License-Identifier: MIT
// The eigensolver: residual, orthogonality and known eigenvalues, on matrices that are hard.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "ad/symmetric_eigen.h"

#ifdef H2MC_HAVE_LAPACKE
#include <lapacke.h>
#endif

namespace h2mc::ad {
namespace {

constexpr int kMax = 34;

struct Matrix {
  int n;
  std::vector<double> a;
  explicit Matrix(int size) : n(size), a(std::size_t(size) * size, 0.0) {}
  double& operator()(int i, int j) { return a[std::size_t(i) * n + j]; }
  double operator()(int i, int j) const { return a[std::size_t(i) * n + j]; }
  double norm() const {
    double largest = 0;
    for (double x : a) largest = std::max(largest, std::abs(x));
    return largest * n;
  }
};

Matrix randomSymmetric(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix m(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) m(i, j) = m(j, i) = normal(random);
  return m;
}

/// Q diag(values) Q^T for a random rotation Q.
Matrix withEigenvalues(const std::vector<double>& values, std::mt19937& random) {
  const int n = int(values.size());
  std::normal_distribution<double> normal;
  Matrix q(n), m(n);
  for (int i = 0; i < n; ++i) {  // Gram-Schmidt, twice
    for (int j = 0; j < n; ++j) q(i, j) = normal(random);
    for (int pass = 0; pass < 2; ++pass)
      for (int k = 0; k < i; ++k) {
        double dot = 0;
        for (int j = 0; j < n; ++j) dot += q(i, j) * q(k, j);
        for (int j = 0; j < n; ++j) q(i, j) -= dot * q(k, j);
      }
    double length = 0;
    for (int j = 0; j < n; ++j) length += q(i, j) * q(i, j);
    for (int j = 0; j < n; ++j) q(i, j) /= std::sqrt(length);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double x = 0;
      for (int k = 0; k < n; ++k) x += q(k, i) * values[k] * q(k, j);
      m(i, j) = m(j, i) = x;
    }
  return m;
}

std::vector<double> sortedValues(const SymmetricEigen<kMax>& eigen) {
  std::vector<double> v;
  for (int k = 0; k < eigen.size(); ++k) v.push_back(eigen.value(k));
  std::sort(v.begin(), v.end());
  return v;
}

/// Solves, checks A v = l v and V V^T = I, and returns the eigenvalues in ascending order.
std::vector<double> check(const Matrix& m) {
  SymmetricEigen<kMax> eigen;
  const int n = m.n;
  EXPECT_TRUE(eigen.compute(m.a.data(), n, n)) << "n=" << n;
  EXPECT_EQ(eigen.size(), n);
  const double eps = 8 * n * std::numeric_limits<double>::epsilon(), norm = m.norm() + 1e-305;
  for (int k = 0; k < n; ++k) {
    const double* v = eigen.vector(k);
    for (int i = 0; i < n; ++i) {
      double x = 0;
      for (int j = 0; j < n; ++j) x += m(i, j) * v[j];
      EXPECT_NEAR(x, eigen.value(k) * v[i], eps * norm) << "n=" << n;
    }
    for (int l = 0; l <= k; ++l) {
      double dot = 0;
      for (int j = 0; j < n; ++j) dot += v[j] * eigen.vector(l)[j];
      EXPECT_NEAR(dot, k == l ? 1 : 0, eps) << "n=" << n << " vectors " << k << "," << l;
    }
    for (int j = n; j < (n + 7) / 8 * 8; ++j) EXPECT_EQ(v[j], 0.0);
  }
  return sortedValues(eigen);
}

void expectValues(const Matrix& m, std::vector<double> want) {
  std::sort(want.begin(), want.end());
  const std::vector<double> got = check(m);
  const double eps = 16 * m.n * std::numeric_limits<double>::epsilon() * m.norm();
  for (int k = 0; k < m.n; ++k) EXPECT_NEAR(got[k], want[k], eps) << "n=" << m.n;
}

TEST(AdSymmetricEigen, RandomMatrices) {
  std::mt19937 random(1);
  for (int n = 1; n <= kMax; ++n)
    for (int repetition = 0; repetition < 10; ++repetition) check(randomSymmetric(n, random));
}

TEST(AdSymmetricEigen, KnownEigenvalues) {
  std::mt19937 random(2);
  for (int n = 1; n <= kMax; ++n) {
    std::vector<double> values(n);
    for (int k = 0; k < n; ++k) values[k] = k - n / 3;
    expectValues(withEigenvalues(values, random), values);
  }
}

TEST(AdSymmetricEigen, RepeatedEigenvaluesAndRankDeficiency) {
  std::mt19937 random(3);
  for (int n = 2; n <= kMax; ++n)
    for (int distinct = 1; distinct <= 3; ++distinct) {
      std::vector<double> values(n);
      for (int k = 0; k < n; ++k) values[k] = k % distinct;  // 0, or 0 and 1, or 0, 1 and 2
      expectValues(withEigenvalues(values, random), values);
    }
}

TEST(AdSymmetricEigen, GradedMatrices) {
  std::mt19937 random(4);
  for (int n = 2; n <= kMax; ++n) {
    std::vector<double> values(n);
    for (int k = 0; k < n; ++k) values[k] = (k % 2 ? -1 : 1) * std::pow(10.0, -14.0 * k / n);
    expectValues(withEigenvalues(values, random), values);
    for (int direction : {-1, 1}) {
      Matrix m = randomSymmetric(n, random);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) m(i, j) *= std::pow(10.0, direction * (i + j));
      check(m);
    }
  }
}

TEST(AdSymmetricEigen, DiagonalTridiagonalAndConstantMatrices) {
  for (int n = 1; n <= kMax; ++n) {
    check(Matrix(n));
    Matrix diagonal(n), ones(n), chain(n), arrow(n);
    std::vector<double> values(n), chainValues(n);
    for (int i = 0; i < n; ++i) {
      values[i] = diagonal(i, i) = 3 * i - 7;
      for (int j = 0; j < n; ++j) ones(i, j) = 1;
      chain(i, i) = 2;
      chainValues[i] = 2 - 2 * std::cos((i + 1) * 3.14159265358979323846 / (n + 1));
      if (i > 0) chain(i, i - 1) = chain(i - 1, i) = -1;
      arrow(i, n - 1) = arrow(n - 1, i) = 1;
    }
    const std::vector<double> got = check(diagonal);
    for (int i = 0; i < n; ++i) EXPECT_EQ(got[i], values[i]);  // nothing to rotate: exact
    expectValues(chain, chainValues);
    std::vector<double> onesValues(n, 0.0);
    onesValues[n - 1] = n;
    expectValues(ones, onesValues);
    check(arrow);
  }
}

TEST(AdSymmetricEigen, ExtremeScales) {
  std::mt19937 random(5);
  for (int n = 1; n <= 12; ++n)
    for (double scale : {1e-300, 1e-160, 1e160, 1e300}) {
      const Matrix unit = randomSymmetric(n, random);
      Matrix m = unit;
      for (double& x : m.a) x *= scale;
      const std::vector<double> want = check(unit), got = check(m);
      for (int k = 0; k < n; ++k) EXPECT_NEAR(got[k] / scale, want[k], 1e-13);
    }
  // A few entries far below the rest: their squares underflow.
  for (int n = 2; n <= 12; ++n)
    for (double tiny : {1e-130, 1e-150, 1e-170, 1e-300, 5e-324}) {
      Matrix m(n);
      m(0, 0) = 1;
      for (int i = 1; i < n; ++i)
        for (int j = 0; j <= i; ++j) m(i, j) = m(j, i) = tiny * (1 + (i * j) % 3);
      check(m);
      std::swap(m(0, 0), m(n - 1, n - 1));
      check(m);
    }
}

TEST(AdSymmetricEigen, TwoByTwo) {
  const double values[] = {0, 1, -1, 1e-8, -3.5, 1e10, 1e-20, 1e-310};
  for (double a : values)
    for (double b : values)
      for (double c : values) {
        Matrix m(2);
        m(0, 0) = a;
        m(1, 0) = m(0, 1) = b;
        m(1, 1) = c;
        check(m);
      }
}

TEST(AdSymmetricEigen, ReadsTheLowerTriangleWithItsStride) {
  std::mt19937 random(6);
  const Matrix m = randomSymmetric(5, random);
  std::vector<double> wide(5 * 9, std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j) wide[i * 9 + j] = m(i, j);
  SymmetricEigen<kMax> eigen;
  ASSERT_TRUE(eigen.compute(wide.data(), 9, 5));
  EXPECT_EQ(sortedValues(eigen), check(m));
}

TEST(AdSymmetricEigen, RefusesWhatIsNotFinite) {
  SymmetricEigen<kMax> eigen;
  const double inf = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= 8; ++n)
    for (double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN()})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j <= i; ++j) {
          Matrix m(n);
          m(i, j) = bad;
          EXPECT_FALSE(eigen.compute(m.a.data(), n, n));
        }
}

#ifdef H2MC_HAVE_LAPACKE
TEST(AdSymmetricEigen, AgreesWithLapack) {
  std::mt19937 random(7);
  for (int n = 1; n <= kMax; ++n) {
    const Matrix m = randomSymmetric(n, random);
    std::vector<double> copy = m.a, values(n);
    ASSERT_EQ(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'L', n, copy.data(), n, values.data()), 0);
    expectValues(m, values);
  }
}
#endif

}  // namespace
}  // namespace h2mc::ad
