// SPDX-License-Identifier: MIT
// Forward-mode automatic differentiation: a number that carries its gradient, and its Hessian if that
// is wanted, with respect to N coordinates.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "ad/dual_layout.h"

namespace h2mc::ad {

template <class S>
concept Arithmetic = std::is_arithmetic_v<S>;

/// A value with its derivatives with respect to N coordinates, N >= 1, T float or double: the gradient
/// (Order 1), or gradient and Hessian (Order 2).
///
/// Default construction leaves everything uninitialised. Plain numbers convert to constants, but
/// an operator that takes the plain number itself is cheaper. Comparisons look at values only.
/// Duals of different N do not mix: see lift.
template <class T, int N, int Order>
struct Dual {
  static_assert(std::is_same_v<T, float> || std::is_same_v<T, double>);
  static_assert(N >= 1 && (Order == 1 || Order == 2));
  using Scalar = T;
  using Layout =
      std::conditional_t<Order == 2, detail::TriangleLayout<T, N>, detail::GradientLayout<T, N>>;
  using Vec = typename Layout::Vec;
  static constexpr int kSize = N;

  struct NoHessian {};
  /// The lower triangle of the Hessian, as Layout has it.
  [[no_unique_address]] std::conditional_t<Order == 2, Vec[std::max(Layout::kHessian, 1)],
                                           NoHessian>
      h;
  Vec g[Layout::kGradient];  ///< gradient, the last vector's as often as it fits
  T v;                       ///< value

  Dual() = default;
  /// A constant.
  template <Arithmetic S>
  H2MC_AD_INLINE Dual(S value) : h{}, g{}, v(static_cast<T>(value)) {}

  /// The coordinate `index` (0 <= index < N) at `value`.
  static H2MC_AD_INLINE Dual variable(T value, int index) {
    Dual r(value);
    r.setGradient(index, T(1));
    return r;
  }

  /// A dual of M coordinates as one of N, its coordinate i becoming i + Offset; M + Offset <= N.
  template <int Offset, int M>
  static H2MC_AD_INLINE Dual lift(const Dual<T, M, Order>& a) {
    static_assert(Offset >= 0 && M + Offset <= N);
    using From = typename Dual<T, M, Order>::Layout;
    Dual r(a.v);
    if constexpr (Order == 2 && Layout::kGradient == 1 && From::kGradient == 1) {
      // By constant shuffles: what is written lane by lane can't be read as a vector soon after.
      using Table = detail::LiftTable<From, Layout, M, N, Offset>;
      r.g[0] = Table::gradient(a.g[0]);
      detail::unroll<Layout::kHessian>([&](auto to) H2MC_AD_LAMBDA {
        constexpr int kTo = to;
        detail::unroll<From::kHessian>([&](auto from) H2MC_AD_LAMBDA {
          if constexpr (Table::reads(kTo, from))
            r.h[kTo] += Table::template triangle<kTo, from>(a.h[from]);
        });
      });
    } else {
      for (int i = 0; i < M; ++i) {
        r.setGradient(i + Offset, a.gradient(i));
        if constexpr (Order == 2)
          for (int j = 0; j <= i; ++j) r.setHessian(i + Offset, j + Offset, a.hessian(i, j));
      }
    }
    return r;
  }

  /// Derivative by coordinate i.
  H2MC_AD_INLINE T gradient(int i) const { return g[i / Layout::kWidth][i % Layout::kWidth]; }
  /// Second derivative by coordinates i and j.
  H2MC_AD_INLINE T hessian(int i, int j) const requires(Order == 2) {
    const int p = i < j ? Layout::position(j, i) : Layout::position(i, j);
    return h[p / Layout::kWidth][p % Layout::kWidth];
  }
  H2MC_AD_INLINE void setGradient(int i, T x) {
    const int block = i / Layout::kWidth, lane = i % Layout::kWidth;
    const int step = block == Layout::kGradient - 1 ? Layout::kRepeat : Layout::kWidth;
    for (int k = lane; k < Layout::kWidth; k += step) g[block][k] = x;
  }
  /// Sets entries (i, j) and (j, i).
  H2MC_AD_INLINE void setHessian(int i, int j, T x) requires(Order == 2) {
    const int p = i < j ? Layout::position(j, i) : Layout::position(i, j);
    h[p / Layout::kWidth][p % Layout::kWidth] = x;
  }

  /// The dual with value `value`, gradient vectors gradient(k) and Hessian vectors hessian(chunk):
  /// what every operation is written with.
  template <class G, class H>
  static H2MC_AD_INLINE Dual make(T value, G&& gradient, H&& hessian) {
    Dual r;
    r.v = value;
    for (int k = 0; k < Layout::kGradient; ++k) r.g[k] = gradient(k);
    Layout::forEachChunk([&](auto c) H2MC_AD_LAMBDA { r.h[c.index] = hessian(c); });
    return r;
  }

  friend H2MC_AD_INLINE Dual operator+(const Dual& a) { return a; }
  friend H2MC_AD_INLINE Dual operator-(const Dual& a) {
    return make(
        -a.v, [&](int k) H2MC_AD_LAMBDA { return -a.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA { return -a.h[c.index]; });
  }
  friend H2MC_AD_INLINE Dual operator+(const Dual& a, const Dual& b) {
    return make(
        a.v + b.v, [&](int k) H2MC_AD_LAMBDA { return a.g[k] + b.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA { return a.h[c.index] + b.h[c.index]; });
  }
  friend H2MC_AD_INLINE Dual operator-(const Dual& a, const Dual& b) {
    return make(
        a.v - b.v, [&](int k) H2MC_AD_LAMBDA { return a.g[k] - b.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA { return a.h[c.index] - b.h[c.index]; });
  }
  friend H2MC_AD_INLINE Dual operator*(const Dual& a, const Dual& b) {
    return make(
        a.v * b.v, [&](int k) H2MC_AD_LAMBDA { return a.v * b.g[k] + b.v * a.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          return a.v * b.h[c.index] + b.v * a.h[c.index] + c.row(a.g) * c.column(b.g) +
                 c.row(b.g) * c.column(a.g);
        });
  }
  friend H2MC_AD_INLINE Dual operator/(const Dual& a, const Dual& b) {
    // With r = a / b: a' = r' b + r b', a'' = r'' b + r' b'^T + b' r'^T + r b''.
    const T r = a.v / b.v, inverse = T(1) / b.v;
    if (!(std::abs(inverse) <= std::numeric_limits<T>::max())) [[unlikely]]
      return quotientByTiny(a, b);
    Vec rg[Layout::kGradient];
    for (int k = 0; k < Layout::kGradient; ++k) rg[k] = (a.g[k] - r * b.g[k]) * inverse;
    return make(
        r, [&](int k) H2MC_AD_LAMBDA { return rg[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          return (a.h[c.index] - r * b.h[c.index] - c.row(rg) * c.column(b.g) -
                  c.row(b.g) * c.column(rg)) *
                 inverse;
        });
  }

  // With a plain number.
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator+(const Dual& a, S s) {
    Dual r = a;
    r.v += static_cast<T>(s);
    return r;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator+(S s, const Dual& a) {
    return a + s;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator-(const Dual& a, S s) {
    Dual r = a;
    r.v -= static_cast<T>(s);
    return r;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator-(S s, const Dual& a) {
    Dual r = -a;
    r.v = static_cast<T>(s) - a.v;
    return r;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator*(const Dual& a, S s) {
    const T t = static_cast<T>(s);
    return make(
        a.v * t, [&](int k) H2MC_AD_LAMBDA { return a.g[k] * t; },
        [&](auto c) H2MC_AD_LAMBDA { return a.h[c.index] * t; });
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator*(S s, const Dual& a) {
    return a * s;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator/(const Dual& a, S s) {
    const T t = static_cast<T>(s), inverse = T(1) / t;
    if (!(std::abs(inverse) <= std::numeric_limits<T>::max())) [[unlikely]]
      return quotientByTiny(a, Dual(t));
    Dual r = a * inverse;
    r.v = a.v / t;
    return r;
  }
  template <Arithmetic S>
  friend H2MC_AD_INLINE Dual operator/(S s, const Dual& a) {
    const T f = static_cast<T>(s) / a.v, f1 = -f / a.v;
    return chain(a, f, f1, T(-2) * f1 / a.v);
  }

  template <class B>
  H2MC_AD_INLINE Dual& operator+=(const B& b) {
    return *this = *this + b;
  }
  template <class B>
  H2MC_AD_INLINE Dual& operator-=(const B& b) {
    return *this = *this - b;
  }
  template <class B>
  H2MC_AD_INLINE Dual& operator*=(const B& b) {
    return *this = *this * b;
  }
  template <class B>
  H2MC_AD_INLINE Dual& operator/=(const B& b) {
    return *this = *this / b;
  }

#define H2MC_AD_COMPARE(op)                                                                   \
  friend H2MC_AD_INLINE bool operator op(const Dual& a, const Dual& b) { return a.v op b.v; } \
  template <Arithmetic S>                                                                     \
  friend H2MC_AD_INLINE bool operator op(const Dual& a, S s) {                                \
    return a.v op static_cast<T>(s);                                                          \
  }                                                                                           \
  template <Arithmetic S>                                                                     \
  friend H2MC_AD_INLINE bool operator op(S s, const Dual& a) {                                \
    return static_cast<T>(s) op a.v;                                                          \
  }
  H2MC_AD_COMPARE(==)
  H2MC_AD_COMPARE(!=)
  H2MC_AD_COMPARE(<)
  H2MC_AD_COMPARE(<=)
  H2MC_AD_COMPARE(>)
  H2MC_AD_COMPARE(>=)
#undef H2MC_AD_COMPARE

  /// f(a) by the chain rule, from f and its first two derivatives at a.v. Where one that is needed is not
  /// finite, coordinates that a does not depend on keep zero derivatives.
  friend H2MC_AD_INLINE Dual chain(const Dual& a, T f, T f1, T f2) {
    if (!isFinite(f1, Order == 2 ? f2 : T(0))) [[unlikely]]
      return chainAtSingularity(a, f, f1, f2);
    return chainSmooth(a, f, f1, f2);
  }
  /// The same for functions whose derivatives are finite wherever their value is.
  friend H2MC_AD_INLINE Dual chainSmooth(const Dual& a, T f, T f1, T f2) {
    Vec t[Layout::kGradient];
    for (int k = 0; k < Layout::kGradient; ++k) t[k] = f2 * a.g[k];
    return make(
        f, [&](int k) H2MC_AD_LAMBDA { return f1 * a.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA { return f1 * a.h[c.index] + c.row(t) * c.column(a.g); });
  }
  /// A logarithm by the chain rule, from its value and its slope: the second derivative -slope^2 leaves
  /// the range of numbers long before what it is multiplied by does.
  friend H2MC_AD_INLINE Dual chainLog(const Dual& a, T f, T slope) {
    if (!(std::abs(slope) <= std::numeric_limits<T>::max())) [[unlikely]]
      return chainAtSingularity(a, f, slope, -slope * slope);
    Vec t[Layout::kGradient];
    for (int k = 0; k < Layout::kGradient; ++k) t[k] = slope * a.g[k];
    return make(
        f, [&](int k) H2MC_AD_LAMBDA { return t[k]; },
        [&](auto c) H2MC_AD_LAMBDA { return slope * a.h[c.index] - c.row(t) * c.column(t); });
  }
  /// f(a, b) by the chain rule, from f and its partial derivatives at (a.v, b.v). Where one of
  /// them is not finite, terms that it multiplies by zero are left out.
  friend H2MC_AD_INLINE Dual chain(const Dual& a, const Dual& b, T f, T fa, T fb, T faa, T fab,
                                   T fbb) {
    if (!(Order == 2 ? isFinite(fa, fb, faa, fab, fbb) : isFinite(fa, fb))) [[unlikely]]
      return chainAtSingularity(a, b, f, fa, fb, faa, fab, fbb);
    Vec ta[Layout::kGradient], tb[Layout::kGradient];
    for (int k = 0; k < Layout::kGradient; ++k) {
      ta[k] = faa * a.g[k] + fab * b.g[k];
      tb[k] = fab * a.g[k] + fbb * b.g[k];
    }
    return make(
        f, [&](int k) H2MC_AD_LAMBDA { return fa * a.g[k] + fb * b.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          return fa * a.h[c.index] + fb * b.h[c.index] + c.row(ta) * c.column(a.g) +
                 c.row(tb) * c.column(b.g);
        });
  }

  /// a x + b y
  friend H2MC_AD_INLINE Dual dot2(const Dual& a, const Dual& x, const Dual& b, const Dual& y) {
    return make(
        a.v * x.v + b.v * y.v,
        [&](int k)
            H2MC_AD_LAMBDA { return a.v * x.g[k] + x.v * a.g[k] + b.v * y.g[k] + y.v * b.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          const auto i = c.index;
          return a.v * x.h[i] + x.v * a.h[i] + c.row(a.g) * c.column(x.g) +
                 c.row(x.g) * c.column(a.g) +
                 (b.v * y.h[i] + y.v * b.h[i] + c.row(b.g) * c.column(y.g) +
                  c.row(y.g) * c.column(b.g));
        });
  }
  /// a x - b y
  friend H2MC_AD_INLINE Dual differenceOfProducts(const Dual& a, const Dual& x, const Dual& b,
                                                  const Dual& y) {
    return make(
        a.v * x.v - b.v * y.v,
        [&](int k)
            H2MC_AD_LAMBDA { return a.v * x.g[k] + x.v * a.g[k] - b.v * y.g[k] - y.v * b.g[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          const auto i = c.index;
          return a.v * x.h[i] + x.v * a.h[i] + c.row(a.g) * c.column(x.g) +
                 c.row(x.g) * c.column(a.g) -
                 (b.v * y.h[i] + y.v * b.h[i] + c.row(b.g) * c.column(y.g) +
                  c.row(y.g) * c.column(b.g));
        });
  }
  /// a x + b y + d z
  friend H2MC_AD_INLINE Dual dot3(const Dual& a, const Dual& x, const Dual& b, const Dual& y,
                                  const Dual& d, const Dual& z) {
    return make(
        a.v * x.v + b.v * y.v + d.v * z.v,
        [&](int k) H2MC_AD_LAMBDA {
          return a.v * x.g[k] + x.v * a.g[k] + b.v * y.g[k] + y.v * b.g[k] +
                 (d.v * z.g[k] + z.v * d.g[k]);
        },
        [&](auto c) H2MC_AD_LAMBDA {
          const auto i = c.index;
          return a.v * x.h[i] + x.v * a.h[i] + c.row(a.g) * c.column(x.g) +
                 c.row(x.g) * c.column(a.g) +
                 (b.v * y.h[i] + y.v * b.h[i] + c.row(b.g) * c.column(y.g) +
                  c.row(y.g) * c.column(b.g)) +
                 (d.v * z.h[i] + z.v * d.h[i] + c.row(d.g) * c.column(z.g) +
                  c.row(z.g) * c.column(d.g));
        });
  }
  /// a^2 + b^2 + d^2
  friend H2MC_AD_INLINE Dual sumOfSquares3(const Dual& a, const Dual& b, const Dual& d) {
    return make(
        a.v * a.v + b.v * b.v + d.v * d.v,
        [&](int k) H2MC_AD_LAMBDA { return T(2) * (a.v * a.g[k] + b.v * b.g[k] + d.v * d.g[k]); },
        [&](auto c) H2MC_AD_LAMBDA {
          const auto i = c.index;
          return T(2) * ((a.v * a.h[i] + b.v * b.h[i] + d.v * d.h[i]) +
                         (c.row(a.g) * c.column(a.g) + c.row(b.g) * c.column(b.g) +
                          c.row(d.g) * c.column(d.g)));
        });
  }
  /// a s + b t
  friend H2MC_AD_INLINE Dual linear2(const Dual& a, T s, const Dual& b, T t) {
    return make(
        a.v * s + b.v * t, [&](int k) H2MC_AD_LAMBDA { return a.g[k] * s + b.g[k] * t; },
        [&](auto c) H2MC_AD_LAMBDA { return a.h[c.index] * s + b.h[c.index] * t; });
  }
  /// a s + b t + d u
  friend H2MC_AD_INLINE Dual linear3(const Dual& a, T s, const Dual& b, T t, const Dual& d, T u) {
    return make(
        a.v * s + b.v * t + d.v * u,
        [&](int k) H2MC_AD_LAMBDA { return a.g[k] * s + b.g[k] * t + d.g[k] * u; },
        [&](auto c)
            H2MC_AD_LAMBDA { return a.h[c.index] * s + b.h[c.index] * t + d.h[c.index] * u; });
  }

  /// Whether the value and all derivatives are finite.
  friend inline bool isFinite(const Dual& a) {
    // x - x is 0, or NaN if x is not finite. Lanes without an entry are as finite as the entries.
    Vec sum = (a.v - a.v) - Vec{};
    for (int k = 0; k < Layout::kGradient; ++k) sum += a.g[k] - a.g[k];
    if constexpr (Order == 2)
      for (int k = 0; k < Layout::kHessian; ++k) sum += a.h[k] - a.h[k];
    T total = 0;
    for (int k = 0; k < Layout::kWidth; ++k) total += sum[k];
    return total == T(0);
  }

 private:
  // Whether all are finite, and their sum.
  template <class... S>
  static H2MC_AD_INLINE bool isFinite(S... x) {
    return (std::abs(x) + ...) <= std::numeric_limits<T>::max();
  }
  // s x, but 0 where either is 0, whatever the other is.
  template <class S>
  static H2MC_AD_INLINE Vec product(const S& s, const Vec& x) {
    const Vec factor = s - Vec{};
    return factor == Vec{} ? Vec{} : x == Vec{} ? Vec{} : factor * x;
  }
  [[gnu::cold, gnu::noinline]] static Dual chainAtSingularity(const Dual& a, T f, T f1, T f2) {
    return make(
        f, [&](int k) H2MC_AD_LAMBDA { return product(f1, a.g[k]); },
        [&](auto c) H2MC_AD_LAMBDA {
          return product(f1, a.h[c.index]) + product(f2, c.row(a.g) * c.column(a.g));
        });
  }
  [[gnu::cold, gnu::noinline]] static Dual chainAtSingularity(const Dual& a, const Dual& b, T f,
                                                              T fa, T fb, T faa, T fab, T fbb) {
    return make(
        f, [&](int k) H2MC_AD_LAMBDA { return product(fa, a.g[k]) + product(fb, b.g[k]); },
        [&](auto c) H2MC_AD_LAMBDA {
          return product(fa, a.h[c.index]) + product(fb, b.h[c.index]) +
                 product(faa, c.row(a.g) * c.column(a.g)) +
                 product(fab, c.row(a.g) * c.column(b.g) + c.row(b.g) * c.column(a.g)) +
                 product(fbb, c.row(b.g) * c.column(b.g));
        });
  }
  // a / b where 1 / b.v overflows (or b.v is 0 or NaN): divides by b.v itself.
  [[gnu::cold, gnu::noinline]] static Dual quotientByTiny(const Dual& a, const Dual& b) {
    const T r = a.v / b.v;
    Vec rg[Layout::kGradient];
    for (int k = 0; k < Layout::kGradient; ++k) rg[k] = (a.g[k] - product(r, b.g[k])) / b.v;
    return make(
        r, [&](int k) H2MC_AD_LAMBDA { return rg[k]; },
        [&](auto c) H2MC_AD_LAMBDA {
          return (a.h[c.index] - product(r, b.h[c.index]) - product(c.row(rg), c.column(b.g)) -
                  product(c.row(b.g), c.column(rg))) /
                 b.v;
        });
  }
};

/// With gradient and Hessian; with the gradient alone.
template <class T, int N>
using Dual2 = Dual<T, N, 2>;
template <class T, int N>
using Dual1 = Dual<T, N, 1>;

}  // namespace h2mc::ad
