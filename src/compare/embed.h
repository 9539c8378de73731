// SPDX-License-Identifier: MIT
// Putting data into a page that needs no other file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/image.h"

namespace h2mc {

// The bits of an IEEE 754 half, rounded to nearest even; too large numbers become the largest finite
// half, what is not a number stays so.
std::uint16_t halfBits(float value);

std::string base64(const std::vector<std::uint8_t>& bytes);

// Values times 2^-exponent as half floats in base64, {exponent, data}: the largest is just below the largest half, so
// that dark pictures do not fall among the denormal numbers. page/pixels.js reads it. Pixels: three values each, row by
// row from the top.
nlohmann::json embeddedValues(std::span<const float> values);
nlohmann::json embeddedPixels(const Image& image);

// The picture times `scale` as sRGB bytes in base64, three a pixel, row by row from the top.
std::string base64Srgb(const Image& image, float scale);

// What brings a picture's values to [0, 1], but for this share of its pixels, the brightest.
float whiteScale(const Image& image, double share = 0.01);

// The page with style, script and data in place of its marks /*STYLE*/, /*SCRIPT*/ and /*DATA*/.
std::string filledPage(std::string_view html, std::string_view style, std::string_view script,
                       const nlohmann::json& data);

}  // namespace h2mc
