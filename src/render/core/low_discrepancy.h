// SPDX-License-Identifier: MIT
// Points that fill the unit square evenly.
#pragma once

#include <cstdint>

namespace h2mc {

struct UnitSquarePoint {
  float x, y;  // in [0, 1)
};

// The n-th point of the (0, 2)-sequence in base 2 of Sobol' [1967]: of any 2^k consecutive ones from a multiple of 2^k,
// each box of area 2^-k with sides that are powers of two, in its grid, has one. n is taken modulo 2^32.
inline UnitSquarePoint sobolPoint(std::uint64_t n) {
  std::uint32_t x = 0, y = 0;
  // The columns of the second generator matrix are those of Pascal's triangle modulo 2.
  std::uint32_t first = 1u << 31, second = 1u << 31;
  for (auto bits = static_cast<std::uint32_t>(n); bits != 0; bits >>= 1) {
    if (bits & 1u) {
      x ^= first;
      y ^= second;
    }
    first >>= 1;
    second ^= second >> 1;
  }
  return {static_cast<float>(x >> 8) * 0x1p-24f, static_cast<float>(y >> 8) * 0x1p-24f};
}

}  // namespace h2mc
