// SPDX-License-Identifier: MIT
#include "byte_mutator.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace h2mc::fuzz {
namespace {

constexpr std::string_view kNumbers[] = {
    "0",     "-0",         "1",           "-1",
    "2",     "0.5",        "1e-7",        "0.999999999",
    "1e15",  "1.1e15",     "16777217",    "255",
    "256",   "65535",      "65536",       "2147483647",
    "1e-45", "2147483648", "-2147483648", "-1e-3",
    "3e38",  "1e39",       "-3e38",       "4294967295",
    "1e400", "1e-400",     "nan",         "-inf",
    "inf",   "1e30",       "1e-30",       "4294967296",
    "1e308", "0x10",       "1,5",         "1e",
    "+1",    "--1",        "1.",          ".5",
    "1e+2",  "90",         "180",         "1e-3",
    "1e3",   "10",         "100",         "33",
    "32",    "1024",       "1025",        "00000001",
    "1e999", "1e-10",      "1e10",        "9223372036854775808"};

// A stretch of the text: where it begins, and its length.
struct Stretch {
  std::size_t begin = 0, length = 0;
};
Stretch stretchOf(const std::string& text, Random& random) {
  if (text.empty()) return {};
  Stretch s;
  s.begin = random.below(text.size());
  const std::size_t longest = random.chance(0.8) ? std::size_t{16} : text.size();
  s.length = 1 + random.below(std::min(longest, text.size() - s.begin));
  return s;
}

void setNumber(std::string& text, Random& random) {
  constexpr std::array<std::uint64_t, 12> kValues = {
      0,           1,           0x7f,        0x80,        0xff,  0x7fff,
      0x7fffffffu, 0x80000000u, 0xffffffffu, 0x7f800000u, ~0ull, 0x7ff0000000000000ull};
  const std::size_t width = std::size_t{1} << random.below(4);
  if (text.size() < width) return;
  std::uint64_t value = random.pick(kValues) + random.below(3) - 1;
  const std::size_t at = random.below(text.size() - width + 1);
  const bool bigEndian = random.chance(0.3);
  for (std::size_t i = 0; i < width; ++i, value >>= 8)
    text[at + (bigEndian ? width - 1 - i : i)] = static_cast<char>(value & 0xff);
}

// Puts another number in the place of one that is written in digits.
void replaceNumber(std::string& text, Random& random) {
  constexpr std::string_view kDigits = "0123456789";
  std::size_t begin = text.find_first_of(kDigits, text.empty() ? 0 : random.below(text.size()));
  if (begin == std::string::npos) begin = text.find_first_of(kDigits);
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
  text.replace(begin, end - begin, wildNumber(random));
}

void change(std::string& text, std::span<const std::string_view> words, Random& random) {
  const Stretch s = stretchOf(text, random);
  switch (random.below(9)) {
    case 0:
      if (!text.empty()) text[s.begin] = static_cast<char>(text[s.begin] ^ 1 << random.below(8));
      break;
    case 1:
      if (!text.empty()) text[s.begin] = static_cast<char>(random.bits() & 0xff);
      break;
    case 2:
      setNumber(text, random);
      break;
    case 3:
      replaceNumber(text, random);
      break;
    case 4:
      text.erase(s.begin, s.length);
      break;
    case 5:
      text.insert(s.begin, text.substr(s.begin, s.length));
      break;
    case 6: {  // moved, or copied over what is there
      const std::string moved = text.substr(s.begin, s.length);
      if (random.chance(0.5)) text.erase(s.begin, s.length);
      const std::size_t to = random.below(text.size() + 1);
      if (random.chance(0.5))
        text.insert(to, moved);
      else
        text.replace(to, moved.size(), moved);
      break;
    }
    case 7:
      if (!words.empty()) {
        const std::string word(random.pick(words));
        if (random.chance(0.5))
          text.insert(s.begin, word);
        else
          text.replace(s.begin, s.length, word);
      }
      break;
    default:
      text.insert(s.begin, 1 + random.below(8), static_cast<char>(random.bits() & 0xff));
  }
}

}  // namespace

std::string mutateBytes(std::string text, std::span<const std::string_view> words, Random& random,
                        std::size_t most) {
  for (std::size_t changes = 1 + random.below(4); changes > 0; --changes)
    change(text, words, random);
  if (text.size() > most) text.resize(most);
  return text;
}

std::string wildNumber(Random& random) {
  if (random.chance(0.5)) return std::string(random.pick(kNumbers));
  std::string text = random.chance(0.2) ? "-" : "";
  text += std::to_string(random.below(10));
  if (random.chance(0.6)) text += "." + std::to_string(random.below(1000));
  if (random.chance(0.2)) text += "e" + std::to_string(static_cast<int>(random.below(60)) - 30);
  return text;
}

}  // namespace h2mc::fuzz
