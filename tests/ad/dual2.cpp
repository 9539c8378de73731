// SPDX-License-Identifier: MIT
// Construction, lifting, comparisons and finiteness of Dual2, for every size and both precisions.

#include <type_traits>

#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

static_assert(std::is_trivially_default_constructible_v<Dual2<float, 6>>);
static_assert(std::is_trivially_copyable_v<Dual2<double, 17>>);
static_assert(std::is_convertible_v<int, Dual2<float, 6>>);
static_assert(std::is_convertible_v<double, Dual2<float, 6>>);
static_assert(std::is_same_v<Dual2<float, 6>::Scalar, float> && Dual2<float, 6>::kSize == 6);

constexpr int kLast = 17;

TEST(AdDual2, VariablesAndConstants) {
  forEachSize<20>([](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    using D = Dual2<T, N>;
    expectConstant(D(3), T(3), "int");
    expectConstant(D(0.5), T(0.5), "double");
    for (int k = 0; k < N; ++k) {
      Expected want;
      want.v = 2;
      want.g[k] = 1;
      expectNear(D::variable(T(2), k), want, 0, "variable");
    }
    D x(T(0)), y(T(0));
    Expected want;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        x.setHessian(i, j, T(100 * i + j));
        y.setHessian(j, i, T(100 * i + j));
        want.h[i][j] = want.h[j][i] = 100 * i + j;
      }
    expectNear(x, want, 0, "setHessian");
    expectNear(y, want, 0, "setHessian, transposed");
  });
}

TEST(AdDual2, LiftsWithOffset) {
  std::mt19937 random(5);
  forEachSize<9>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int M = decltype(c)::kSize;
    const auto a = randomDual<T, M>(T(1.25), random);
    const auto check = [&]<int Offset, int N>(std::integer_sequence<int, Offset, N>) {
      const auto b = Dual2<T, N>::template lift<Offset>(a);
      const Expected from = expand(a);
      Expected want;
      want.v = from.v;
      for (int i = 0; i < M; ++i) {
        want.g[i + Offset] = from.g[i];
        for (int j = 0; j < M; ++j) want.h[i + Offset][j + Offset] = from.h[i][j];
      }
      expectNear(b, want, 0, "lift");
    };
    check(std::integer_sequence<int, 0, M>{});
    check(std::integer_sequence<int, 0, M + 1>{});
    check(std::integer_sequence<int, 1, M + 1>{});
    check(std::integer_sequence<int, 2, M + 4>{});
    check(std::integer_sequence<int, 0, 16>{});
    check(std::integer_sequence<int, 16 - M, 16>{});
    check(std::integer_sequence<int, 3, 20>{});
  });
}

TEST(AdDual2, ComparesValuesOnly) {
  using D = Dual2<float, 3>;
  const D one = D::variable(1, 0), alsoOne = D(1), two = D::variable(2, 1);
  EXPECT_TRUE(one == alsoOne && !(one != alsoOne) && one <= alsoOne && one >= alsoOne);
  EXPECT_TRUE(one < two && two > one && one != two && !(two <= one) && !(one >= two));
  EXPECT_TRUE(one == 1 && 1 == one && one < 2 && 2 > one && 0.5 < one && one >= 1.f && 1 <= one);
  EXPECT_TRUE(one != 2 && 2 != one && one > 0 && 0 <= one && one <= 1);
  const D nan = D(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(nan == nan || nan < one || nan > one);
  EXPECT_TRUE(nan != nan);
}

TEST(AdDual2, IsFiniteSeesEveryEntry) {
  forEachSize<20>([](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    using D = Dual2<T, N>;
    const T inf = std::numeric_limits<T>::infinity(), nan = std::numeric_limits<T>::quiet_NaN();
    const D max(std::numeric_limits<T>::max());
    EXPECT_TRUE(isFinite(max) && isFinite(D(-1)) && isFinite(-max));
    int missed = 0;
    for (const T bad : {inf, -inf, nan}) {
      missed += isFinite(D(bad));
      for (int i = 0; i < N; ++i) {
        D x(1);
        x.setGradient(i, bad);
        missed += isFinite(x);
        for (int j = 0; j <= i; ++j) {
          D y(1);
          y.setHessian(i, j, bad);
          missed += isFinite(y);
        }
      }
    }
    EXPECT_EQ(missed, 0) << N;
  });
}

// A quotient of constants has no derivative, even where 1 / b overflows.
TEST(AdDual2, ConstantsStayConstant) {
  forEachSize<kLast>([](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    using D = Dual2<T, N>;
    const T tiny = std::numeric_limits<T>::denorm_min();
    expectConstant(D(2 * tiny) / D(tiny), T(2), "tiny / tiny");
    expectConstant(D(2 * tiny) / tiny, T(2), "tiny / plain tiny");
    expectConstant((2 * tiny) / D(tiny), T(2), "plain tiny / tiny");
    expectConstant(D(0) / D(tiny), T(0), "0 / tiny");
    expectConstant(D(0) * D(5) + D(2) - 1, T(1), "arithmetic");
    // Dividing an active number by a tiny one gives what is representable.
    const D x = D::variable(2 * tiny, N - 1) / D(T(0.25));
    EXPECT_EQ(x.gradient(N - 1), T(4));
  });
}

}  // namespace
}  // namespace h2mc::ad
