// SPDX-License-Identifier: MIT
// What an image that is read may have.
#pragma once

#include <cstdint>

namespace h2mc {

// Pixels, unless the command line says another number.
inline constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;
// Call it before other threads start.
void setMostPixels(std::uint64_t count);

}  // namespace h2mc
