// SPDX-License-Identifier: MIT
#include "render/scene/value_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "render/scene/spectrum.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  if (text.size() > kMost) return "\"" + std::string(text.substr(0, kMost)) + "...\"";
  return "\"" + std::string(text) + "\"";
}

float decodeSrgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

Rgbf checkedColor(const std::vector<double>& c, bool mayBeNegative) {
  for (double x : c)
    if (x < 0 && !mayBeNegative) throw ValueError("a colour must not be negative");
  if (c.size() == 1) return Rgbf(static_cast<float>(c[0]));
  return Rgbf(static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]));
}

}  // namespace

bool isOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

double parseNumber(std::string_view text) {
  const std::string_view all = trimmed(text);
  std::string_view digits = all;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  if (digits.empty()) throw ValueError("a number is missing");
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::invalid_argument || end != digits.data() + digits.size())
    throw ValueError(quoted(all) + " is not a number");
  if (code == std::errc::result_out_of_range) {
    // Too small or too large: a negative exponent tells.
    const std::size_t exponent = digits.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos && exponent + 1 < digits.size() &&
                      digits[exponent + 1] == '-';
    if (tiny) return 0;
    throw ValueError(quoted(all) + " is too large a number");
  }
  if (!std::isfinite(value)) throw ValueError(quoted(all) + " is not a finite number");
  if (std::fabs(value) > static_cast<double>(std::numeric_limits<float>::max()))
    throw ValueError(quoted(all) + " is too large a number");
  return value;
}

long long parseInteger(std::string_view text) {
  const std::string_view all = trimmed(text);
  std::string_view digits = all;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  long long value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::result_out_of_range)
    throw ValueError(quoted(all) + " is too large an integer");
  if (digits.empty() || code != std::errc() || end != digits.data() + digits.size())
    throw ValueError(quoted(all) + " is not an integer");
  return value;
}

bool parseBoolean(std::string_view text) {
  const std::string word = lowerCase(trimmed(text));
  if (word == "true") return true;
  if (word == "false") return false;
  throw ValueError(quoted(trimmed(text)) + " is neither true nor false");
}

std::vector<std::string_view> splitList(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t i = 0;
  while (i < text.size()) {
    while (i < text.size() && (isSpace(text[i]) || text[i] == ',')) ++i;
    const std::size_t begin = i;
    while (i < text.size() && !isSpace(text[i]) && text[i] != ',') ++i;
    if (i > begin) parts.push_back(text.substr(begin, i - begin));
  }
  return parts;
}

std::vector<double> parseNumbers(std::string_view text) {
  std::vector<double> numbers;
  for (std::string_view part : splitList(text)) numbers.push_back(parseNumber(part));
  return numbers;
}

Rgbf parseRgb(std::string_view text, bool srgb, bool mayBeNegative) {
  const std::string_view word = trimmed(text);
  Rgbf color;
  if (!word.empty() && word[0] == '#') {
    unsigned code = 0;
    const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), code, 16);
    if (word.size() != 7 || error != std::errc() || end != word.data() + word.size())
      throw ValueError(quoted(word) + " is not a colour of the form #rrggbb");
    color = Rgbf(static_cast<float>(code >> 16 & 255u), static_cast<float>(code >> 8 & 255u),
                 static_cast<float>(code & 255u)) /
            255.f;
  } else {
    const std::vector<double> c = parseNumbers(word);
    if (c.size() != 1 && c.size() != 3)
      throw ValueError("a colour has 1 or 3 numbers, here are " + std::to_string(c.size()));
    color = checkedColor(c, mayBeNegative);
  }
  if (srgb) color = Rgbf(decodeSrgb(color.x), decodeSrgb(color.y), decodeSrgb(color.z));
  return color;
}

Rgbf parseSpectrum(std::string_view text, bool mayBeNegative, Rgbf* saturated) {
  if (text.find(':') == std::string_view::npos) return parseRgb(text, false, mayBeNegative);
  std::vector<SpectrumSample> samples;
  for (std::string_view part : splitList(text)) {
    const std::size_t colon = part.find(':');
    if (colon == std::string_view::npos)
      throw ValueError(quoted(part) + " is not of the form wavelength:value");
    samples.push_back({parseNumber(part.substr(0, colon)), parseNumber(part.substr(colon + 1))});
    if (samples.size() > 1 && samples.back().wavelength <= samples[samples.size() - 2].wavelength)
      throw ValueError("the wavelengths of a spectrum must increase");
    if (samples.back().value < 0 && !mayBeNegative)
      throw ValueError("a spectrum must not be negative");
  }
  return intoGamut(spectrumToRgb(samples), saturated);
}

}  // namespace h2mc
