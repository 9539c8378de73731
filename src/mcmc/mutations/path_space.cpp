// SPDX-License-Identifier: MIT
#include "mcmc/mutations/path_space.h"

#include <cassert>

namespace h2mc {

const PathSpaceState& pathSpaceAt(const Scene& scene, ChainState& state,
                                  Slot<PathSpaceState> slot) {
  auto& [value, known] = state.derived[slot];
  if (known) return value;
  known = true;
  [[maybe_unused]] const bool lit = toFull(scene, state.path, value.path);
  assert(lit);
  value.densities = densities(scene, value.path);
  return value;
}

}  // namespace h2mc
