// SPDX-License-Identifier: MIT
// Functions of one active number, at the price of one chain rule.
#pragma once

#include "render/core/types.h"

namespace h2mc {

// f(x), where f maps any scalar type to itself. With a derivative type f is differentiated by x
// alone and joined to x's own derivatives in one step, so that a long formula in one variable (a
// Fresnel term, a masking function) costs little more than a product, however many coordinates x
// depends on.
template <class T, class F>
T ofOne(const T& x, F&& f) {
  if constexpr (ad::dimension < T >> 1) {
    using One = ad::Dual<Scalar<T>, 1, ad::order<T>>;
    const One y = f(One::variable(value(x), 0));
    if constexpr (ad::order<T> == 1)
      return chain(x, y.v, y.gradient(0), 0);
    else
      return chain(x, y.v, y.gradient(0), y.hessian(0, 0));
  } else {
    return f(x);
  }
}

}  // namespace h2mc
