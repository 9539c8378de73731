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
      const D x = D::variable(T(2), k);
      EXPECT_EQ(x.v, T(2));
      for (int i = 0; i < N; ++i) {
        EXPECT_EQ(x.gradient(i), i == k ? T(1) : T(0));
        for (int j = 0; j < N; ++j) EXPECT_EQ(x.hessian(i, j), T(0));
      }
    }
    D x(T(0));
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) x.setHessian(j, i, T(100 * i + j));
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        EXPECT_EQ(x.hessian(i, j), T(100 * i + j));
        EXPECT_EQ(x.hessian(j, i), T(100 * i + j));
      }
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
      EXPECT_EQ(b.v, a.v);
      const auto inside = [&](int i) { return i >= Offset && i < Offset + M; };
      for (int i = 0; i < N; ++i) {
        EXPECT_EQ(b.gradient(i), inside(i) ? a.gradient(i - Offset) : T(0));
        for (int j = 0; j < N; ++j)
          EXPECT_EQ(b.hessian(i, j),
                    inside(i) && inside(j) ? a.hessian(i - Offset, j - Offset) : T(0))
              << M << " to " << N << " at " << Offset << ": " << i << "," << j;
      }
      EXPECT_TRUE(isFinite(b));
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
    for (const T bad : {inf, -inf, nan}) {
      EXPECT_FALSE(isFinite(D(bad)));
      for (int i = 0; i < N; ++i) {
        D x(1);
        x.setGradient(i, bad);
        EXPECT_FALSE(isFinite(x)) << N << " gradient " << i;
        for (int j = 0; j <= i; ++j) {
          D y(1);
          y.setHessian(i, j, bad);
          EXPECT_FALSE(isFinite(y)) << N << " Hessian " << i << "," << j;
        }
      }
    }
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
