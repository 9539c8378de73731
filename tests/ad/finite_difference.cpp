// SPDX-License-Identifier: MIT
// Finite differences against known derivatives, and composite expressions of duals against finite
// differences.

#include "ad/finite_difference.h"

#include "ad/vec3.h"
#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

TEST(AdFiniteDifference, KnownDerivativesWithinTheirErrors) {
  const auto check = [](auto one, double tolerance) {
    using R = decltype(one);
    const R x[3] = {R(0.7), R(-0.4), R(1.3)};
    const auto f = [](const R* p) { return std::exp(p[0]) * std::sin(p[1]) + p[2] * p[2] * p[0]; };
    const auto d = finiteDifferences<R>(f, x, 3);
    const R e = std::exp(x[0]), s = std::sin(x[1]), c = std::cos(x[1]);
    const R gradient[3] = {e * s + x[2] * x[2], e * c, 2 * x[2] * x[0]};
    const R hessian[3][3] = {{e * s, e * c, 2 * x[2]}, {e * c, -e * s, 0}, {2 * x[2], 0, 2 * x[0]}};
    EXPECT_EQ(d.value, f(x));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(d.gradient[i].value, gradient[i], 10 * d.gradient[i].error);
      EXPECT_LT(d.gradient[i].error, tolerance);
      for (int j = 0; j < 3; ++j) {
        EXPECT_NEAR(d.hessian[3 * i + j].value, hessian[i][j], 10 * d.hessian[3 * i + j].error);
        EXPECT_LT(d.hessian[3 * i + j].error, 100 * tolerance);
      }
    }
  };
  check(1.0, 1e-11);
  check(1.0L, 1e-14);
}

TEST(AdFiniteDifference, LeavesOutStepsThatLeaveTheDomain) {
  const double x[1] = {0.01};
  const auto d = finiteDifferences<double>([](const double* p) { return std::log(*p); }, x, 1);
  EXPECT_NEAR(d.gradient[0].value, 100, 1e-5);
  EXPECT_NEAR(d.hessian[0].value, -10000, 1);
  const double zero[1] = {0};
  const auto none =
      finiteDifferences<double>([](const double* p) { return std::log(*p); }, zero, 1);
  EXPECT_TRUE(std::isnan(none.gradient[0].error));
}

/// Everything at once, of a few or many coordinates.
template <class D>
D composite(const D* x, int n) {
  using S = Scalar<D>;
  const auto at = [&](int i) { return x[i % n]; };
  const Vec3<D> p(at(0), at(1) * S(2), at(2) + S(1)), q(at(3) - S(1), at(4), at(5));
  const Vec3<S> plain(S(0.3), S(-0.2), S(0.9));
  const Vec3<D> h = normalize(normalize(p - q) + plain);
  D s, c;
  sincos(at(6) + at(7), s, c);
  D y = log(S(2) + dot(h, plain)) * exp(-length2(cross(p, plain))) + s * c;
  for (int i = 0; i < n; ++i)
    y += pow(x[i] + S(2), S(1.5)) * atan2(x[i], S(1) + at(i + 3) * at(i + 1)) / (S(1) + S(i));
  return y + sqrt(S(1) + square(at(8))) * acos(at(9) * S(0.5)) + erf(at(10)) -
         log1p(square(at(11)));
}

template <class T, int N>
void compareWithDifferences(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.2, 0.8);
  double x[N];
  Dual2<T, N> duals[N];
  for (int i = 0; i < N; ++i) {
    const T v = T(uniform(random));
    x[i] = v;
    duals[i] = Dual2<T, N>::variable(v, i);
  }
  const auto f = [](const double* p) { return composite(p, N); };
  const auto want = finiteDifferences<double>(f, x, N);
  const auto got = composite(duals, N);
  const double eps = sizeof(T) == 4 ? 2e-5 : 1e-10;
  EXPECT_TRUE(isFinite(got));
  EXPECT_NEAR(got.v, want.value, eps * 10);
  for (int i = 0; i < N; ++i) {
    EXPECT_NEAR(got.gradient(i), want.gradient[i].value, eps * 10 + 10 * want.gradient[i].error)
        << N << " gradient " << i;
    for (int j = 0; j < N; ++j)
      EXPECT_NEAR(got.hessian(i, j), want.hessian[i * N + j].value,
                  eps * 20 + 10 * want.hessian[i * N + j].error)
          << N << " Hessian " << i << "," << j;
  }
}

TEST(AdFiniteDifference, CompositeExpressionOfFloats) {
  std::mt19937 random(1);
  compareWithDifferences<float, 1>(random);
  compareWithDifferences<float, 2>(random);
  compareWithDifferences<float, 6>(random);
  compareWithDifferences<float, 7>(random);
  compareWithDifferences<float, 13>(random);
}

TEST(AdFiniteDifference, CompositeExpressionOfDoubles) {
  std::mt19937 random(2);
  compareWithDifferences<double, 3>(random);
  compareWithDifferences<double, 6>(random);
  compareWithDifferences<double, 12>(random);
}

}  // namespace
}  // namespace h2mc::ad
