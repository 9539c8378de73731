// SPDX-License-Identifier: MIT
// Finds a path through a pixel.
#pragma once

#include "inspect/inspect.h"
#include "mcmc/chain/chain.h"

namespace h2mc {

// Traces bidirectional samples through the pixel, draws one of their connections of minLength edges
// and more that arrive in it in proportion to its target, and goes on from there by a chain of the
// mixture's small steps that rejects what leaves the pixel. `path` becomes the chain's last state, or
// the path with the largest target of all that were met. False if nothing contributes.
bool findPath(const SceneTarget& target, KernelMixture& kernels, int minLength,
              const InspectSettings& settings, Path& path, PathSearch& search);

// The pixel that a film position in [0, 1) belongs to, along an edge of so many pixels.
int pixelAt(float film, int pixels);

}  // namespace h2mc
