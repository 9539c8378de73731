// SPDX-License-Identifier: MIT
// ad::Composition on recurrences whose derivatives Dual2 gives as a whole.
#include "ad/composition.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "ad/functions.h"
#include "render/core/index.h"

namespace h2mc::ad {
namespace {

// x' = f(x, u): two state variables, one control, nothing linear about it.
template <class T>
std::array<T, 2> advance(const T& x, const T& y, const T& u) {
  return {sin(x * u) + y * y * 0.3, exp(y * 0.2 - u * u) + x * u};
}
template <class T>
T reward(const T& x, const T& y, const T& u) {
  return log(x * x + y * y + u * u + 1.5);
}

constexpr int kSteps = 9;

// log(e^(sum of rewards) + 2 e^(3 y_n)) - 2 log-sum-exp_2(x_n, y_n, 0), in one piece.
template <class T>
T whole(const T* u) {
  T x(0.3), y(-0.2), sum(0.0);
  for (int k = 0; k < kSteps; ++k) {
    sum = sum + reward(x, y, u[k]);
    const auto next = advance(x, y, u[k]);
    x = next[0];
    y = next[1];
  }
  return log(exp(sum) + exp(y * 3.0) * 2.0) - log(exp(x * 2.0) + exp(y * 2.0) + 1.0);
}

// The same step by step, with `extra` coordinates before and after that nothing depends on.
template <class T>
void composed(Composition<T>& c, const std::vector<T>& u, int extra, T& value,
              std::vector<T>& gradient, std::vector<T>& hessian) {
  const int n = static_cast<int>(u.size());
  c.begin(u.data(), n);
  int x = c.constant(T(0.3)), y = c.constant(T(-0.2)), sum = c.none();
  for (int k = 0; k < kSteps; ++k) {
    using D = Dual2<T, 3>;
    const int inputs[3] = {x, y, k + extra};
    D d[3];
    for (int i = 0; i < 3; ++i) d[i] = D::variable(c.value(inputs[i]), i);
    const auto next = advance(d[0], d[1], d[2]);
    D* const outputs = c.template outputs<3>(3);
    outputs[0] = next[0];
    outputs[1] = next[1];
    outputs[2] = reward(d[0], d[1], d[2]);
    const int first = c.apply(inputs, 3);
    x = first;
    y = first + 1;
    sum = c.sum(sum, first + 2);
  }
  const int brighter = c.linear({{y, T(3)}, {c.constant(T(std::log(2.0))), T(1)}});
  const int a[2] = {sum, brighter}, b[3] = {x, y, c.constant(T(0))};
  const int l = c.linear({{c.logSumExp(a, 2, T(1)), T(1)}, {c.logSumExp(b, 3, T(2)), T(-2)}});
  value = c.value(l);
  gradient.resize(u.size());
  hessian.resize(u.size() * (u.size() + 1) / 2);
  c.differentiate(l, gradient.data(), hessian.data());
}

template <class T>
class AdComposition : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(AdComposition, Scalars);

TYPED_TEST(AdComposition, Recurrence) {
  using T = TypeParam;
  const T tolerance = std::is_same_v<T, float> ? T(2e-3) : T(1e-11);
  std::mt19937 random(1);
  std::uniform_real_distribution<T> uniform(T(-0.9), T(0.9));
  Composition<T> composition;
  // Also more coordinates than a register has lanes, and than a few of them.
  for (const int extra : {0, 4, 40, 70}) {
    std::vector<T> u(static_cast<std::size_t>(kSteps + 2 * extra));
    for (T& x : u) x = uniform(random);
    T value;
    std::vector<T> gradient, hessian;
    composed(composition, u, extra, value, gradient, hessian);

    using D = Dual2<double, kSteps>;
    D active[kSteps];
    for (int k = 0; k < kSteps; ++k) active[k] = D::variable(double(u[at(k + extra)]), k);
    const D expected = whole(active);
    EXPECT_NEAR(value, expected.v, tolerance * (1 + std::abs(expected.v)));
    const auto lane = [&](int i) { return i - extra; };
    const auto active0 = [&](int i) { return lane(i) >= 0 && lane(i) < kSteps; };
    std::size_t k = 0;
    for (int i = 0; i < kSteps + 2 * extra; ++i) {
      const double g = active0(i) ? expected.gradient(lane(i)) : 0;
      EXPECT_NEAR(gradient[at(i)], g, tolerance * (1 + std::abs(g)));
      for (int j = 0; j <= i; ++j, ++k) {
        const double h = active0(i) && active0(j) ? expected.hessian(lane(i), lane(j)) : 0;
        EXPECT_NEAR(hessian[k], h, tolerance * (1 + std::abs(h))) << i << ", " << j;
      }
    }
  }
}

TYPED_TEST(AdComposition, LogSumExpIsNeitherTooLargeNorTooSmall) {
  using T = TypeParam;
  Composition<T> c;
  const T u[2] = {T(300), T(-400)};
  c.begin(u, 2);
  const int z[2] = {0, 1};
  const int l = c.logSumExp(z, 2, T(2));
  EXPECT_EQ(c.value(l), T(300));
  T gradient[2], hessian[3];
  c.differentiate(l, gradient, hessian);
  EXPECT_EQ(gradient[0], T(1));
  EXPECT_EQ(gradient[1], T(0));
  for (const T h : hessian) EXPECT_EQ(h, T(0));
}

TYPED_TEST(AdComposition, WhatHasNoWeightNeedNotBeFinite) {
  using T = TypeParam;
  using D = Dual2<T, 1>;
  Composition<T> c;
  const T u[1] = {T(0.5)};
  c.begin(u, 1);
  D* const outputs = c.template outputs<1>(1);
  outputs[0] = log(D::variable(T(0.5), 0) * std::numeric_limits<T>::denorm_min());
  outputs[0].setGradient(0, std::numeric_limits<T>::infinity());
  const int inputs[1] = {0};
  const int z[2] = {c.apply(inputs, 1), 0};
  T gradient[1], hessian[1];
  c.differentiate(c.logSumExp(z, 2, T(20)), gradient, hessian);
  EXPECT_EQ(gradient[0], T(1));
  EXPECT_EQ(hessian[0], T(0));
}

TYPED_TEST(AdComposition, OneTermIsItself) {
  Composition<TypeParam> c;
  const TypeParam u[1] = {TypeParam(2)};
  c.begin(u, 1);
  const int z[1] = {0};
  EXPECT_EQ(c.logSumExp(z, 1, TypeParam(2)), 0);
  EXPECT_EQ(c.sum(c.none(), 0), 0);
}

// What differentiate() returns: what the terms are over what is left of them, 1 at most where nothing cancels.
TYPED_TEST(AdComposition, TellsHowMuchTermsCancel) {
  using T = TypeParam;
  using D = Dual2<T, 2>;
  Composition<T> c;
  // Of 20 coordinates, which are in more than one vector.
  std::vector<T> u(20, T(0.5)), gradient(20), hessian(210);
  // scale (u_i u_i + 3 u_i u_j)
  const auto quadratic = [&](int i, int j, T scale) {
    D* const outputs = c.template outputs<2>(1);
    const D x = D::variable(u[at(i)], 0), y = D::variable(u[at(j)], 1);
    outputs[0] = (x * x + x * y * T(3)) * scale;
    const int inputs[2] = {i, j};
    return c.apply(inputs, 1);
  };
  const auto magnified = [&](std::initializer_list<std::array<int, 3>> terms) {
    c.begin(u.data(), 20);
    int sum = c.none();
    for (const auto& [i, j, scale] : terms) sum = c.sum(sum, quadratic(i, j, T(scale)));
    return c.differentiate(sum, gradient.data(), hessian.data());
  };
  const T tolerance = 100 * std::numeric_limits<T>::epsilon();
  for (const int j : {1, 19}) {
    EXPECT_NEAR(magnified({{0, j, 5}, {0, j, 4}}), T(2) / T(3), tolerance);
    // 2 * 1999 on the diagonal, of which 2 is left, and 3 beside it.
    EXPECT_NEAR(magnified({{0, j, 1000}, {0, j, -999}}), T(3998) / T(3), 3998 * tolerance);
    EXPECT_NEAR(magnified({{0, j, 1000}, {0, j, -1000}}), T(4000), 4000 * tolerance);
    // Others cancel, but they are small beside what is left.
    EXPECT_NEAR(magnified({{0, j, 10}, {0, j, -10}, {j, 3, 1000}}), T(2) / T(3), tolerance);
  }
}

// The same of what bends log-sum-exp.
TYPED_TEST(AdComposition, TellsHowMuchLogSumExpCancels) {
  using T = TypeParam;
  Composition<T> c;
  const T u[2] = {T(0.5), T(0.5)};
  T gradient[2], hessian[3];
  c.begin(u, 2);
  const int z[2] = {0, 1};
  // Each has a Hessian of +-25 everywhere.
  const int a = c.logSumExp(z, 2, T(100)),
            b = c.logSumExpOfSum(0, c.constant(T(0)), 1, c.none(), T(100));
  const T magnified = c.differentiate(c.linear({{a, T(3)}, {b, T(-2)}}), gradient, hessian);
  EXPECT_NEAR(hessian[0], T(25), T(1e-3));
  EXPECT_NEAR(magnified, T(5), T(1e-3));
}

// The fused form of what sum() and logSumExp() make in three steps.
TYPED_TEST(AdComposition, LogSumExpOfSum) {
  using T = TypeParam;
  const T tolerance = 50 * std::numeric_limits<T>::epsilon();
  std::mt19937 random(2);
  std::uniform_real_distribution<T> uniform(T(-1), T(1));
  Composition<T> c;
  for (const int n : {4, 30}) {
    std::vector<T> u(static_cast<std::size_t>(n));
    // Near each other, and so far apart that the smaller one does not count.
    for (const T distance : {T(1), T(200)}) {
      for (T& x : u) x = uniform(random);
      u[3] *= distance;
      for (int absent = 0; absent < 16; ++absent) {
        const auto evaluate = [&](bool fused, T* gradient, T* hessian) {
          c.begin(u.data(), n);
          // Functions of all coordinates, none of them a coordinate.
          int v[4];
          for (int i = 0; i < 4; ++i) {
            v[i] = c.linear({{i, T(2)}, {n - 1, T(1 + i)}});
            if (absent >> i & 1) v[i] = c.none();
          }
          int result = c.none();
          if (fused) {
            result = c.logSumExpOfSum(v[0], v[1], v[3], v[2], T(2));
          } else {
            int z[2], count = 0;
            if (v[0] != c.none() && v[1] != c.none()) z[count++] = c.sum(v[0], v[1]);
            if (v[3] != c.none()) z[count++] = v[3];
            if (count > 0) result = c.sum(c.logSumExp(z, count, T(2)), v[2]);
          }
          if (result == c.none()) return T(0);
          c.differentiate(result, gradient, hessian);
          return c.value(result);
        };
        const auto size = at(n);
        std::vector<T> g(size), h(size * (size + 1) / 2), wantG(g), wantH(h);
        const T value = evaluate(true, g.data(), h.data());
        EXPECT_NEAR(value, evaluate(false, wantG.data(), wantH.data()), 10 * distance * tolerance);
        for (std::size_t i = 0; i < g.size(); ++i) EXPECT_NEAR(g[i], wantG[i], 10 * tolerance);
        for (std::size_t i = 0; i < h.size(); ++i) EXPECT_NEAR(h[i], wantH[i], 100 * tolerance);
      }
    }
  }
}

}  // namespace
}  // namespace h2mc::ad
