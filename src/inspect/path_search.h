// SPDX-License-Identifier: MIT
// Finds a path through a pixel.
#pragma once

#include "inspect/inspect.h"
#include "mcmc/chain/chain.h"

namespace h2mc {

// Traces bidirectional samples through the pixel, draws `count` of their connections of minLength edges
// and more that arrive in it in proportion to their target, and goes on from each by a chain of the
// mixture's small steps that rejects what leaves the pixel, all chains together with the settings' mutations.
// Returns the chains' last states; with PathChoice::kLargest the one path with the largest target of all that were met.
// Empty if nothing contributes.
std::vector<Path> findPaths(const SceneTarget& target, KernelMixture& kernels, int minLength,
                            const InspectSettings& settings, std::size_t count, PathSearch& search);

// The pixel that a film position in [0, 1) belongs to, along an edge of so many pixels.
int pixelAt(float film, int pixels);

}  // namespace h2mc
