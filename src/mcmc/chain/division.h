// SPDX-License-Identifier: MIT
// Which part of a path's contribution is estimated by chains, and which by independent samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/core/index.h"

namespace h2mc {

// The octave of a state's target, floor(log2(target / mean)), lies between minus and plus this.
inline constexpr int kHighestOctave = 20;
inline constexpr std::size_t kOctaves = 2 * kHighestOctave + 1;
// Precondition: ratio > 0.
inline int octaveOf(double ratio) {
  return std::clamp(std::ilogb(ratio), -kHighestOctave, kHighestOctave);
}
// Its index in tables.
inline std::size_t octaveRow(int octave) { return at(octave + kHighestOctave); }

// Paths are estimated twice, by the states of chains and by independent samples: of a path of target f samples take the
// share level / (f + level), states the rest. Any level is right, and a function of f as well as a number. Where there
// are n states and m samples that cover the primary spaces with density 1, level = (mean of f) m / n is the balance
// heuristic [Kelemen et al. 2002, section 3.4; Veach 1997, section 9.2] if the states were independent. Of states of
// which `held` successive ones are alike there are only n / held, and the level is `held` times as high.
struct Division {
  double level = 0;
  // By the octave of the target over `mean`; null: 1.
  const double* held = nullptr;
  double mean = 1;

  double levelAt(double target) const {
    return held && target > 0 ? level * held[octaveRow(octaveOf(target / mean))] : level;
  }
  // By what the contribution of a state of this target is to be divided, f / (f + level) over f.
  double ofState(double target) const { return target + levelAt(target); }
  // The share of a sample's path of this target; in [0, 1].
  double ofSample(double target) const {
    const double here = levelAt(target);
    return here > 0 ? here / (target + here) : 0;
  }
};

}  // namespace h2mc
