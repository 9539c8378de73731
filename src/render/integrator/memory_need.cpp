// SPDX-License-Identifier: MIT
#include "render/integrator/memory_need.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/core/input_file.h"
#include "render/core/memory.h"

namespace h2mc {

MemoryItem filmMemory(const FilmSettings& film, double bytesAPixel) {
  return {static_cast<double>(film.width) * film.height * bytesAPixel,
          fmt::format("films and images of {} x {} pixels", film.width, film.height),
          "expected a smaller width or height"};
}

void requireMemory(const std::vector<MemoryItem>& items) {
  double bytes = 0;
  for (const MemoryItem& item : items) bytes += item.bytes;
  constexpr double kAlways = 64e6;  // what is so little is not asked about
  if (bytes <= kAlways || bytes <= memoryLeft().bytes) return;
  std::vector<MemoryItem> sorted = items;
  std::sort(sorted.begin(), sorted.end(),
            [](const MemoryItem& a, const MemoryItem& b) { return a.bytes > b.bytes; });
  std::string parts;
  for (const MemoryItem& item : sorted)
    if (item.bytes > 0.001 * bytes)
      parts +=
          fmt::format("{}{} for {}", parts.empty() ? "" : ", ", sizeText(item.bytes), item.what);
  requireMemory(bytes, "this render (" + parts + ")", sorted.front().remedy);
}

}  // namespace h2mc
