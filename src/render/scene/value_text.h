// SPDX-License-Identifier: MIT
// Values as they are written in scene files: numbers, lists of numbers, colours.
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "render/core/types.h"

namespace h2mc {

// A value that cannot be read; what() says why, without a place.
class ValueError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// XML's white space.
constexpr bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
std::string_view trimmed(std::string_view text);
bool isOneOf(std::string_view name, std::initializer_list<std::string_view> names);

// All throw ValueError. Numbers are finite, also as float where they become one.
double parseNumber(std::string_view text);
long long parseInteger(std::string_view text);
bool parseBoolean(std::string_view text);  // true or false, in any case

// Numbers between commas and white space; any count, possibly none.
std::vector<double> parseNumbers(std::string_view text);
std::vector<std::string_view> splitList(std::string_view text);

// "r, g, b", one number for grey, or "#rrggbb". Decoded from sRGB on demand. Not negative unless
// that is allowed.
Rgbf parseRgb(std::string_view text, bool srgb, bool mayBeNegative = false);

// A <spectrum>: one number, three numbers, or "wavelength:value, ..." in nanometres, which intoGamut() makes a colour.
Rgbf parseSpectrum(std::string_view text, bool mayBeNegative = false, Rgbf* saturated = nullptr);

}  // namespace h2mc
