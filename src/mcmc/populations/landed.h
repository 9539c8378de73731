// SPDX-License-Identifier: MIT
// How many mutations have landed on each pixel, each shared between where it was and what it proposed.
#pragma once

#include <vector>

#include "render/image/film.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {

// The settings of a film to count on: counts are not spread over pixels.
inline FilmSettings unfiltered(FilmSettings settings) {
  settings.filter = Filter();
  return settings;
}

// The counts that were splatted on such a film, row by row.
inline std::vector<float> landedCounts(const Film& film, int threads) {
  const auto width = at(film.width());
  std::vector<float> counts(width * at(film.height()));
  const double pixels = static_cast<double>(counts.size());
  parallelFor(threads, film.height(), [&](int y) {
    for (int x = 0; x < film.width(); ++x)
      counts[at(y) * width + at(x)] = film.pixel(x, y, 1 / pixels).x;  // by the film's area
  });
  return counts;
}

}  // namespace h2mc
