// SPDX-License-Identifier: MIT
// The functions of duals against closed forms, and at the points where they have no derivative.

#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;
constexpr Extended kPi = 3.14159265358979323846264338327950288L;

// Functions are instantiated for a few sizes: each of them is one call of chain, which is tested
// for every size here and in ad_dual2.cpp.
template <class F>
void forSomeSizes(F&& f) {
  callWith<Case<float, 2>>(f);
  callWith<Case<float, 7>>(f);
  callWith<Case<double, 6>>(f);
  callWith<Case<double, 17>>(f);
}

TEST(AdFunctions, ChainRuleOfOneArgument) {
  std::mt19937 random(1);
  forEachSize<17>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(0.5), random);
    const auto want = chainOf(expand(a), 3, -2, 0.75L);
    expectNear(chain(a, T(3), T(-2), T(0.75)), want, 8, "chain");
    expectNear(chainSmooth(a, T(3), T(-2), T(0.75)), want, 8, "chainSmooth");
  });
}

// 1 / a is beyond float there.
TEST(AdFunctions, LogarithmBelowTheNormalNumbers) {
  using D = Dual2<float, 2>;
  const D y = log(D::variable(1.f, 0) * 0x1p-130f);
  EXPECT_FLOAT_EQ(y.v, std::log(2.f) * -130);
  EXPECT_FLOAT_EQ(y.gradient(0), 1);
  EXPECT_FLOAT_EQ(y.hessian(0, 0), -1);
  EXPECT_EQ(y.gradient(1), 0);
}

TEST(AdFunctions, ChainRuleOfTwoArguments) {
  std::mt19937 random(2);
  forEachSize<17>([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    const auto a = randomDual<T, N>(T(0.5), random), b = randomDual<T, N>(T(2), random);
    expectNear(chain(a, b, T(3), T(-2), T(0.75), T(1.5), T(-0.25), T(4)),
               chainOf(expand(a), expand(b), {3, -2, 0.75L, 1.5L, -0.25L, 4}), 16, "chain");
  });
}

TEST(AdFunctions, ClosedForms) {
  std::mt19937 random(3);
  forSomeSizes([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    for (const T v : {T(0.015625), T(0.3), T(0.96875)}) {
      for (const T sign : {T(1), T(-1)}) {
        const auto a = randomDual<T, N>(sign * v, random);
        const Expected e = expand(a);
        const Extended x = a.v, ulps = 64;
        const Extended q = 1 - x * x, i = 1 / (1 + x * x), t = std::tan(x);
        expectNear(exp(a), chainOf(e, std::exp(x), std::exp(x), std::exp(x)), ulps, "exp");
        expectNear(expm1(a), chainOf(e, std::expm1(x), std::exp(x), std::exp(x)), ulps, "expm1");
        expectNear(log1p(a), chainOf(e, std::log1p(x), 1 / (1 + x), -1 / ((1 + x) * (1 + x))),
                   32 * ulps, "log1p");
        expectNear(sin(a), chainOf(e, std::sin(x), std::cos(x), -std::sin(x)), ulps, "sin");
        expectNear(cos(a), chainOf(e, std::cos(x), -std::sin(x), -std::cos(x)), ulps, "cos");
        expectNear(tan(a), chainOf(e, t, 1 + t * t, 2 * t * (1 + t * t)), ulps, "tan");
        expectNear(asin(a), chainOf(e, std::asin(x), 1 / std::sqrt(q), x / (q * std::sqrt(q))),
                   ulps, "asin");
        expectNear(acos(a), chainOf(e, std::acos(x), -1 / std::sqrt(q), -x / (q * std::sqrt(q))),
                   ulps, "acos");
        expectNear(atan(a), chainOf(e, std::atan(x), i, -2 * x * i * i), ulps, "atan");
        const Extended erf1 = 2 / std::sqrt(kPi) * std::exp(-x * x);
        expectNear(erf(a), chainOf(e, std::erf(x), erf1, -2 * x * erf1), ulps, "erf");
        expectNear(abs(a), chainOf(e, std::abs(x), x < 0 ? -1 : 1, 0), 1, "abs");
        expectNear(square(a), chainOf(e, x * x, 2 * x, 2), ulps, "square");
        expectNear(pow(a, 3), chainOf(e, x * x * x, 3 * x * x, 6 * x), ulps, "pow 3");
        expectNear(pow(a, -1), chainOf(e, 1 / x, -1 / (x * x), 2 / (x * x * x)), ulps, "pow -1");
        auto s = a, k = a;
        sincos(a, s, k);
        expectNear(s, expand(sin(a)), 8, "sincos");
        expectNear(k, expand(cos(a)), 8, "sincos");
        sincos(s, s, k);
        expectNear(s, expand(sin(sin(a))), 64, "sincos in place");
      }
      const auto a = randomDual<T, N>(v, random);
      const Expected e = expand(a);
      const Extended x = a.v, r = std::sqrt(x), ulps = 64;
      expectNear(sqrt(a), chainOf(e, r, 0.5L / r, -0.25L / (r * x)), ulps, "sqrt");
      expectNear(rsqrt(a), chainOf(e, 1 / r, -0.5L / (r * x), 0.75L / (r * x * x)), ulps, "rsqrt");
      expectNear(log(a), chainOf(e, std::log(x), 1 / x, -1 / (x * x)), ulps, "log");
      for (const T p : {T(0.5), T(2.5), T(-1.25), T(1), T(0)}) {
        const Extended f = std::pow(x, Extended(p));
        expectNear(pow(a, p), chainOf(e, f, p * f / x, p * (p - 1) * f / (x * x)), 8 * ulps, "pow");
        const Extended g = std::pow(Extended(2.5), x), l = std::log(Extended(2.5));
        expectNear(pow(T(2.5), a), chainOf(e, g, g * l, g * l * l), ulps, "pow(plain, dual)");
      }
    }
  });
}

TEST(AdFunctions, ClosedFormsOfTwoArguments) {
  std::mt19937 random(4);
  forSomeSizes([&](auto c) {
    using T = typename decltype(c)::Scalar;
    constexpr int N = decltype(c)::kSize;
    for (const T v : {T(0.3), T(-1.75), T(1e-12), T(1e12)})
      for (const T w : {T(0.8), T(-0.4), T(1e-12), T(-1e12)}) {
        const auto a = randomDual<T, N>(v, random), b = randomDual<T, N>(w, random);
        const Extended y = v, x = w, r2 = x * x + y * y, r = std::sqrt(r2), r4 = r2 * r2;
        expectNear(atan2(a, b),
                   chainOf(expand(a), expand(b),
                           {std::atan2(y, x), x / r2, -y / r2, -2 * x * y / r4,
                            (y - x) * (y + x) / r4, 2 * x * y / r4}),
                   128, "atan2");
        expectNear(
            hypot(a, b),
            chainOf(expand(a), expand(b),
                    {r, y / r, x / r, x * x / (r2 * r), -x * y / (r2 * r), y * y / (r2 * r)}),
            128, "hypot");
      }
    const auto a = randomDual<T, N>(T(0.7), random), p = randomDual<T, N>(T(1.3), random);
    const Extended x = a.v, y = p.v, f = std::pow(x, y), l = std::log(x);
    expectNear(
        pow(a, p),
        chainOf(expand(a), expand(p),
                {f, y * f / x, f * l, y * (y - 1) * f / (x * x), f / x * (1 + y * l), f * l * l}),
        256, "pow");
  });
}

TEST(AdFunctions, ConstantsHaveNoDerivativesAtSingularPoints) {
  forSomeSizes([](auto c) {
    using T = typename decltype(c)::Scalar;
    using D = Dual2<T, decltype(c)::kSize>;
    const T denormal = std::numeric_limits<T>::denorm_min(), tiny = std::numeric_limits<T>::min();
    for (const T v : {T(0), denormal, tiny, T(1)}) {
      expectConstant(sqrt(D(v)), std::sqrt(v), "sqrt");
      for (const T p : {T(0), T(0.5), T(1), T(1.5), T(2), T(3)}) {
        expectConstant(pow(D(v), p), std::pow(v, p), "pow(x, plain)");
        expectConstant(pow(D(v), D(p)), std::pow(v, p), "pow(x, p)");
        expectConstant(pow(v, D(p)), std::pow(v, p), "pow(plain, p)");
      }
      expectConstant(atan2(D(v), D(0)), std::atan2(v, T(0)), "atan2");
      expectConstant(hypot(D(v), D(0)), std::hypot(v, T(0)), "hypot");
      expectConstant(abs(D(v)), v, "abs");
    }
    for (const T v : {T(1), T(-1)}) {
      expectConstant(asin(D(v)), std::asin(v), "asin");
      expectConstant(acos(D(v)), std::acos(v), "acos");
      expectConstant(pow(D(v), D(3)), v, "pow");
    }
    expectConstant(log(D(tiny)), std::log(tiny), "log");
    expectConstant(rsqrt(D(tiny)), 1 / std::sqrt(tiny), "rsqrt");
    expectConstant(1 / D(2 * tiny), 1 / (2 * tiny), "1 / x");
    expectConstant(atan(D(std::numeric_limits<T>::infinity())), std::atan(T(INFINITY)), "atan");
    expectConstant(erf(D(std::numeric_limits<T>::infinity())), T(1), "erf");
    expectConstant(exp(D(-std::numeric_limits<T>::infinity())), T(0), "exp");
  });
}

// Where one coordinate's derivative is infinite, the coordinates not involved keep theirs at zero.
TEST(AdFunctions, SingularPointsSpareOtherCoordinates) {
  using D = Dual2<float, 5>;
  const D x = D::variable(0, 2), one = D::variable(1, 2);
  for (const D& y : {sqrt(x), pow(x, 0.5f), acos(one), asin(one), pow(x, D(0.5f)), atan2(x, x),
                     hypot(x, D(0)), log(x), D(D::variable(1e-30f, 2)) / D(1e-45f)}) {
    EXPECT_FALSE(isFinite(y));
    for (int i = 0; i < 5; ++i) {
      EXPECT_TRUE(i == 2 || y.gradient(i) == 0);
      for (int j = 0; j < 5; ++j) EXPECT_TRUE((i == 2 && j == 2) || y.hessian(i, j) == 0);
    }
  }
  EXPECT_EQ(sqrt(x).v, 0);
  EXPECT_EQ(acos(one).v, 0);
  EXPECT_EQ(atan2(x, x).v, 0);
}

TEST(AdFunctions, IntegerPowersAtZeroAreExact) {
  using D = Dual2<double, 2>;
  const D x = D::variable(0, 1);
  const double gradient[] = {0, 1, 0, 0}, hessian[] = {0, 0, 2, 0};
  for (int p = 0; p < 4; ++p) {
    for (const D& y : {pow(x, p), pow(x, D(p))}) {
      EXPECT_EQ(y.v, p == 0 ? 1 : 0);
      EXPECT_EQ(y.gradient(1), gradient[p]) << p;
      EXPECT_EQ(y.hessian(1, 1), hessian[p]) << p;
      EXPECT_EQ(y.gradient(0), 0);
    }
  }
  // x^2 underflows, its derivatives do not.
  const auto y = pow(Dual2<float, 1>::variable(1e-30f, 0), 2);
  EXPECT_FLOAT_EQ(y.gradient(0), 2e-30f);
  EXPECT_FLOAT_EQ(y.hessian(0, 0), 2);
}

TEST(AdFunctions, ChoiceByValue) {
  using D = Dual2<float, 3>;
  const D a = D::variable(1, 0), b = D::variable(2, 1);
  EXPECT_EQ(min(a, b).gradient(0), 1);
  EXPECT_EQ(max(a, b).gradient(1), 1);
  EXPECT_EQ(min(b, a).gradient(0), 1);
  EXPECT_EQ(max(b, a).gradient(1), 1);
  EXPECT_EQ(min(a, 0.5f).gradient(0), 0);
  EXPECT_EQ(min(a, 0.5f).v, 0.5f);
  EXPECT_EQ(max(0, a).gradient(0), 1);
  EXPECT_EQ(max(a, 3).v, 3);
  EXPECT_EQ(min(3, a).gradient(0), 1);
  EXPECT_EQ(select(true, a, b).gradient(0), 1);
  EXPECT_EQ(select(false, a, b).gradient(1), 1);
  EXPECT_EQ(clamp(a, 0, 2).gradient(0), 1);
  EXPECT_EQ(clamp(a, 1, 2).gradient(0), 1);
  EXPECT_EQ(clamp(b, 0, 1).gradient(1), 0);
  EXPECT_EQ(clamp(b, 0, 1).v, 1);
  EXPECT_EQ(ad::clamp(3.f, 0.f, 1.f), 1.f);
  EXPECT_EQ(ad::min(1., 2.) + ad::max(1., 2.) + ad::select(true, 1., 2.), 4.);
}

TEST(AdFunctions, PlainNumbers) {
  const auto check = [](auto x) {
    using T = decltype(x);
    T s, c;
    ad::sincos(x, s, c);
    EXPECT_EQ(s, std::sin(x));
    EXPECT_EQ(c, std::cos(x));
    EXPECT_EQ(ad::sqrt(x), std::sqrt(x));
    EXPECT_EQ(ad::rsqrt(x), 1 / std::sqrt(x));
    EXPECT_EQ(ad::pow(x, 3), std::pow(x, T(3)));
    EXPECT_EQ(ad::square(x), x * x);
    EXPECT_EQ(ad::atan2(x, T(2)), std::atan2(x, T(2)));
    EXPECT_EQ(value(x), x);
    EXPECT_TRUE(ad::isFinite(x));
    EXPECT_FALSE(ad::isFinite(x / T(0)));
    EXPECT_FALSE(ad::isFinite(std::numeric_limits<T>::quiet_NaN()));
    static_assert(std::is_same_v<decltype(ad::exp(x)), T>);
    static_assert(std::is_same_v<Scalar<T>, T> && !isDual<T> && dimension<T> == 0);
    static_assert(std::is_same_v<Scalar<Dual2<T, 6>>, T> && isDual<const Dual2<T, 6>&>);
    static_assert(dimension<Dual2<T, 6>> == 6);
    static_assert(std::numeric_limits<Dual2<T, 6>>::is_iec559);
  };
  check(0.375f);
  check(0.375);
}

}  // namespace
}  // namespace h2mc::ad
