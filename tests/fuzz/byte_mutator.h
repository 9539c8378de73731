// SPDX-License-Identifier: MIT
// Small changes of a text or a binary file, for all formats alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace h2mc::fuzz {

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  std::uint64_t bits() { return generator_(); }
  // In [0, count); count > 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }
  bool chance(double probability) { return unit() < probability; }
  double unit() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  template <class List>
  const auto& pick(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937_64 generator_;
};

// The changed text, at most `most` bytes long.
using ByteMutator = std::function<std::string(std::string, std::size_t most)>;

// Flips bits, sets bytes and numbers to the borders of their ranges, inserts words of the format, and deletes, doubles
// and moves stretches: one to four of these.
std::string mutateBytes(std::string text, std::span<const std::string_view> words, Random& random,
                        std::size_t most);

// A decimal number as texts have it, often one at the border of what readers can take.
std::string wildNumber(Random& random);

}  // namespace h2mc::fuzz
