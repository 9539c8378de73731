// SPDX-License-Identifier: MIT
#include "render/scene/ranges.h"

#include <fmt/format.h>

#include <algorithm>

namespace h2mc {
namespace {

[[noreturn]] void failWith(const Properties& p, std::string_view name, const std::string& value,
                           const std::string& expected) {
  p.fail(name, fmt::format("\"{}\" is {}, expected {}", name, value, expected));
  throw;  // not reached
}

}  // namespace

float numberIn(const Properties& p, std::string_view name, float low, float high) {
  const float value = p.number(name);
  if (!(value >= low && value <= high))
    failWith(p, name, fmt::format("{:g}", value),
             fmt::format("a number from {:g} to {:g}", low, high));
  return value;
}

float numberAbove0(const Properties& p, std::string_view name, float high) {
  const float value = p.number(name);
  if (!(value > 0 && value <= high))
    failWith(p, name, fmt::format("{:g}", value),
             fmt::format("a number above 0 and up to {:g}", high));
  return value;
}

int integerIn(const Properties& p, std::string_view name, int low, int high) {
  const int value = p.integer(name);
  if (value < low || value > high)
    failWith(p, name, fmt::format("{}", value),
             fmt::format("a whole number from {} to {}", low, high));
  return value;
}

float readGamma(const Properties& p) {
  constexpr float kLow = 0.1f, kHigh = 10;
  const float gamma = p.number("gamma");
  if (gamma != 0 && gamma != -1 && !(gamma >= kLow && gamma <= kHigh))
    failWith(p, "gamma", fmt::format("{:g}", gamma),
             fmt::format("-1 for sRGB, 0 for what the file says, or an exponent from {:g} to {:g}",
                         kLow, kHigh));
  return gamma;
}

TexturePtr textureUpTo(const Properties& p, std::string_view name, float high) {
  TexturePtr texture = p.texture(name);
  const Rgbf most = maximum(*texture);
  const float value = std::max({most.x, most.y, most.z});
  if (!(value <= high))
    failWith(p, name, fmt::format("up to {:g}", value), fmt::format("values up to {:g}", high));
  return texture;
}

}  // namespace h2mc
