// SPDX-License-Identifier: MIT
// What a render will take, reckoned before it begins.
#pragma once

#include <string>
#include <vector>

#include "render/camera/film_settings.h"

namespace h2mc {

struct MemoryItem {
  double bytes;        // at the moment when all items together are most
  std::string what;    // "512 chains"
  std::string remedy;  // "fewer by the option \"chains\""
};

// Films and images that take so many bytes a pixel in all.
MemoryItem filmMemory(const FilmSettings& film, double bytesAPixel);

// Throws MemoryError where the items together are more than there is (memoryLeft): with the figure of each, and the
// remedy for the largest.
void requireMemory(const std::vector<MemoryItem>& items);

}  // namespace h2mc
