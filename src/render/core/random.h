// SPDX-License-Identifier: MIT
// Random streams that belong to a chain, a tile or a bootstrap sample, never to a thread.
#pragma once

#include <cstdint>

namespace h2mc {

// SplitMix64's finaliser: spreads structured keys (seed, stream, index) over 64 bits.
inline std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// PCG32 [O'Neill 2014]. The same (seed, stream, index) always gives the same numbers, so a path
// can be replayed from its key alone.
class Random {
 public:
  Random() : Random(0, 0, 0) {}
  Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index)
      : increment_((mixBits(mixBits(seed) ^ stream) << 1) | 1u),
        state_(mixBits(mixBits(mixBits(seed) + stream) ^ index)) {
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
    const auto rotation = static_cast<std::uint32_t>(old >> 59u);
    return (shifted >> rotation) | (shifted << ((32u - rotation) & 31u));
  }

  // Uniform in [0, 1), a multiple of 2^-24: every value is exact in float.
  float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }

  // Uniform in [0, 1), a multiple of 2^-53.
  double uniformDouble() {
    const std::uint64_t high = next(), low = next();
    return static_cast<double>(((high << 32) | low) >> 11) * 0x1p-53;
  }

  // Standard normal (Box-Muller; the pair's second half is kept for the next call).
  float normal();

 private:
  std::uint64_t increment_;
  std::uint64_t state_;
  float spare_ = 0;
  bool hasSpare_ = false;
};

}  // namespace h2mc
