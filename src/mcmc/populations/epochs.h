// SPDX-License-Identifier: MIT
// How long epochs are, between which is learned.
#pragma once

#include <algorithm>
#include <cmath>

namespace h2mc {

// The first epoch's mutations a pixel, and how many times as many there are in all by the end of each further one.
inline constexpr double kFirstEpoch = 4, kEpochGrowth = 4;

// The mutations a pixel by the end of epoch number `epoch`, the first being 0 and having `first`.
inline double epochEnd(int epoch, double first = kFirstEpoch) {
  return first * std::pow(kEpochGrowth, epoch);
}

// Edge of square cells, in pixels, that have 256 mutations each: for these a picture is known well enough.
inline int knownCell(double mutationsPerPixel) {
  constexpr double kMutationsPerCell = 256;
  return std::max(1, static_cast<int>(std::lround(
                         std::sqrt(kMutationsPerCell / std::max(mutationsPerPixel, 1e-6)))));
}

}  // namespace h2mc
