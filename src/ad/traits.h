// SPDX-License-Identifier: MIT
// What templated code asks of its scalar, which may be float, double or a dual.
#pragma once

#include <limits>
#include <type_traits>

#include "ad/dual.h"

namespace h2mc::ad {

namespace detail {
template <class T>
struct Traits {
  using Scalar = T;
  static constexpr bool isDual = false;
  static constexpr int dimension = 0, order = 0;
};
template <class T, int N, int O>
struct Traits<Dual<T, N, O>> {
  using Scalar = T;
  static constexpr bool isDual = true;
  static constexpr int dimension = N, order = O;
};
}  // namespace detail

/// The plain number under T: float for float and for Dual2<float, N>.
template <class T>
using Scalar = typename detail::Traits<std::remove_cvref_t<T>>::Scalar;

template <class T>
inline constexpr bool isDual = detail::Traits<std::remove_cvref_t<T>>::isDual;

/// Number of coordinates that a T is differentiated by; 0 for a plain number.
template <class T>
inline constexpr int dimension = detail::Traits<std::remove_cvref_t<T>>::dimension;

/// Order of the derivatives that a T carries; 0 for a plain number.
template <class T>
inline constexpr int order = detail::Traits<std::remove_cvref_t<T>>::order;

template <class T>
concept AnyDual = isDual<T>;

/// The value without its derivatives.
template <Arithmetic T>
H2MC_AD_INLINE T value(T x) {
  return x;
}
template <class T, int N, int O>
H2MC_AD_INLINE T value(const Dual<T, N, O>& x) {
  return x.v;
}

}  // namespace h2mc::ad

/// A dual has the limits of its value; GLM asks for them.
template <class T, int N, int O>
struct std::numeric_limits<h2mc::ad::Dual<T, N, O>> : std::numeric_limits<T> {};
