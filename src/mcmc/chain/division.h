// SPDX-License-Identifier: MIT
// Which part of a path's contribution is estimated by chains, and which by independent samples.
#pragma once

namespace h2mc {

// Paths are estimated twice, by the states of chains and by independent samples: of a path of target f samples take the
// share level / (f + level), states the rest. Any level is right. Where there are n states and m samples that cover
// the primary spaces with density 1, level = (mean of f) m / n is the balance heuristic [Kelemen et al. 2002, section
// 3.4; Veach 1997, section 9.2].
struct Division {
  double level = 0;

  // By what the contribution of a state of this target is to be divided, f / (f + level) over f.
  double ofState(double target) const { return target + level; }
  // The share of a sample's path of this target; in [0, 1].
  double ofSample(double target) const { return level > 0 ? level / (target + level) : 0; }
};

}  // namespace h2mc
