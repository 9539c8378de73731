// SPDX-License-Identifier: MIT
#include "compare/embed.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/image/color_encoding.h"

namespace h2mc {
namespace {

void replaceOnce(std::string& text, const std::string& what, std::string_view by) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
}

// As text inside a <script> element, which no "<" can end or comment out.
std::string scriptJson(const nlohmann::json& value) {
  std::string text = value.dump();
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6)
    text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

std::uint16_t halfBits(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000u;
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7e00u);
  const double magnitude = std::abs(static_cast<double>(value));
  constexpr std::uint16_t kLargest = 0x7bff;
  if (magnitude >= 65504) return static_cast<std::uint16_t>(sign | kLargest);
  // Units in the last place: 2^-24 below 2^-14, else 2^-10 of the power of two below.
  const int exponent = magnitude > 0 ? std::max(std::ilogb(magnitude), -14) : -14;
  const double units = std::nearbyint(std::ldexp(magnitude, 10 - exponent));
  const std::uint32_t rounded = static_cast<std::uint32_t>(units);  // 0 .. 2048
  // The carry out of the mantissa raises the exponent, as it should.
  const std::uint32_t biased = static_cast<std::uint32_t>(exponent + 14) << 10;
  return static_cast<std::uint16_t>(sign | std::min<std::uint32_t>(biased + rounded, kLargest));
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

nlohmann::json embeddedValues(std::span<const float> values) {
  float largest = 0;
  for (const float v : values)
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  const int exponent = largest > 0 ? std::ilogb(largest) - 14 : 0;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * 2);
  for (const float v : values) {
    const std::uint16_t half = halfBits(std::ldexp(v, -exponent));
    bytes.push_back(static_cast<std::uint8_t>(half & 255));
    bytes.push_back(static_cast<std::uint8_t>(half >> 8));
  }
  return {{"exponent", exponent}, {"data", base64(bytes)}};
}

nlohmann::json embeddedPixels(const Image& image) {
  std::vector<float> values;
  values.reserve(image.pixels.size() * 3);
  for (const Rgbf& p : image.pixels)
    for (int c = 0; c < 3; ++c) values.push_back(p[c]);
  return embeddedValues(values);
}

std::string base64Srgb(const Image& image, float scale) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Rgbf& p : image.pixels)
    for (int c = 0; c < 3; ++c)
      bytes.push_back(
          static_cast<std::uint8_t>(255 * linearToSrgb(std::clamp(scale * p[c], 0.f, 1.f)) + 0.5f));
  return base64(bytes);
}

float whiteScale(const Image& image, double share) {
  std::vector<float> largest;
  for (const Rgbf& p : image.pixels) largest.push_back(std::max({p.x, p.y, p.z}));
  const double below = static_cast<double>(largest.size()) * (1 - share);
  const auto nth =
      largest.begin() + std::min(static_cast<std::ptrdiff_t>(below), std::ssize(largest) - 1);
  std::nth_element(largest.begin(), nth, largest.end());
  return *nth > 0 ? 1 / *nth : 1;
}

std::string filledPage(std::string_view html, std::string_view style, std::string_view script,
                       const nlohmann::json& data) {
  std::string page(html);
  replaceOnce(page, "/*STYLE*/", style);
  replaceOnce(page, "/*SCRIPT*/", script);
  replaceOnce(page, "/*DATA*/", scriptJson(data));
  return page;
}

}  // namespace h2mc
