// SPDX-License-Identifier: MIT
// What the tests of src/ad share: random duals, and closed forms to hold results against.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "ad/dual.h"
#include "ad/functions.h"
#include "ad/traits.h"

namespace h2mc::ad::test {

using Extended = long double;

/// A dual in plain arrays, in long double.
struct Expected {
  Extended v = 0;
  std::array<Extended, 24> g{};
  std::array<std::array<Extended, 24>, 24> h{};
};

template <class T, int N>
[[gnu::noinline]] Expected expand(const Dual2<T, N>& a) {
  Expected e;
  e.v = a.v;
  for (int i = 0; i < N; ++i) {
    e.g[i] = a.gradient(i);
    for (int j = 0; j < N; ++j) e.h[i][j] = a.hessian(i, j);
  }
  return e;
}

/// f(a) from f, f' and f'' at a.v.
inline Expected chainOf(const Expected& a, Extended f, Extended f1, Extended f2) {
  Expected e;
  e.v = f;
  for (int i = 0; i < 24; ++i) {
    e.g[i] = f1 * a.g[i];
    for (int j = 0; j < 24; ++j) e.h[i][j] = f1 * a.h[i][j] + f2 * a.g[i] * a.g[j];
  }
  return e;
}

struct Partials {
  Extended f, a, b, aa, ab, bb;
};
/// f(a, b) from its partial derivatives.
inline Expected chainOf(const Expected& a, const Expected& b, const Partials& p) {
  Expected e;
  e.v = p.f;
  for (int i = 0; i < 24; ++i) {
    e.g[i] = p.a * a.g[i] + p.b * b.g[i];
    for (int j = 0; j < 24; ++j)
      e.h[i][j] = p.a * a.h[i][j] + p.b * b.h[i][j] + p.aa * a.g[i] * a.g[j] +
                  p.ab * (a.g[i] * b.g[j] + a.g[j] * b.g[i]) + p.bb * b.g[i] * b.g[j];
  }
  return e;
}

/// Fails where `got` is further from `want` than `eps`, relative to the largest entry of the same order. Not a
/// template, and so compiled once in each file rather than for every size and precision.
[[gnu::noinline]] inline void expectNear(const Expected& got, const Expected& want, int n,
                                         Extended eps, const char* what) {
  Extended gradientScale = 0, hessianScale = 0;
  for (int i = 0; i < n; ++i) {
    gradientScale = std::max(gradientScale, std::abs(want.g[i]));
    for (int j = 0; j < n; ++j) hessianScale = std::max(hessianScale, std::abs(want.h[i][j]));
  }
  EXPECT_NEAR(got.v, want.v, eps * std::max<Extended>(std::abs(want.v), 1e-3L))
      << what << " N=" << n;
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(got.g[i], want.g[i], eps * gradientScale)
        << what << " N=" << n << " gradient " << i;
    for (int j = 0; j < n; ++j)
      EXPECT_NEAR(got.h[i][j], want.h[i][j], eps * hessianScale)
          << what << " N=" << n << " Hessian " << i << "," << j;
  }
}

/// The same in units of the precision of T.
template <class T, int N>
void expectNear(const Dual2<T, N>& got, const Expected& want, Extended ulps, const char* what) {
  expectNear(expand(got), want, N, ulps * std::numeric_limits<T>::epsilon(), what);
}

/// Fails unless every derivative is exactly zero and the value is `value`.
template <class T, int N>
void expectConstant(const Dual2<T, N>& got, T value, const char* what) {
  Expected constant;
  constant.v = value;
  expectNear(expand(got), constant, N, 0, what);
}

/// A dual with value `value` and random derivatives in [-1, 1].
template <class T, int N>
[[gnu::noinline]] Dual2<T, N> randomDual(T value, std::mt19937& random) {
  std::uniform_real_distribution<T> uniform(-1, 1);
  Dual2<T, N> a(value);
  for (int i = 0; i < N; ++i) {
    a.setGradient(i, uniform(random));
    for (int j = 0; j <= i; ++j) a.setHessian(i, j, uniform(random));
  }
  return a;
}

template <class T, int N>
struct Case {
  using Scalar = T;
  static constexpr int kSize = N;
};

// One function for each case: compilers take far longer over one that holds them all.
template <class C, class F>
[[gnu::noinline]] void callWith(F& f) {
  f(C{});
}

/// Calls f(Case<T, N>{}) for each N in 1 .. Last and T float and double.
template <int Last, class F>
void forEachSize(F&& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) {
    (callWith<Case<float, I + 1>>(f), ...);
    (callWith<Case<double, I + 1>>(f), ...);
  }
  (std::make_integer_sequence<int, Last>{});
}

}  // namespace h2mc::ad::test
