// SPDX-License-Identifier: MIT
// What a render can tell of each pixel beside its value.
#pragma once

namespace h2mc {

// What is asked for. Each costs memory, and a little time, where it is.
struct PixelStatistics {
  bool variance = false;  // of the pixel's value, from two halves of what it is made of
  bool counts = false;    // how many mutations or samples have landed on it
};

}  // namespace h2mc
