// SPDX-License-Identifier: MIT
// Signed counts as indices of the standard library's containers, and the end of a half-open interval.
#pragma once

#include <algorithm>
#include <cstddef>

namespace h2mc {

// Precondition: i >= 0.
template <class I>
constexpr std::size_t at(I i) {
  return static_cast<std::size_t>(i);
}

}  // namespace h2mc
