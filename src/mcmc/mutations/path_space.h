// SPDX-License-Identifier: MIT
// A chain's state seen as a path: what every mutation in path space begins with.
#pragma once

#include "mcmc/chain/mutation.h"
#include "render/path/path_densities.h"

namespace h2mc {

// A state's path, whatever the technique that made it, and how all techniques make it.
struct PathSpaceState {
  FullPath path;
  TechniqueDensities densities;
};

// Found out once for all mutations of a mixture, whose setup gives them the same slot. Precondition:
// state.path.target > 0.
const PathSpaceState& pathSpaceAt(const Scene& scene, ChainState& state, Slot<PathSpaceState> slot);

}  // namespace h2mc
