// SPDX-License-Identifier: MIT
// From path space to primary sample space: the primary sample with which a technique makes a given path.
#pragma once

#include <cstdint>

#include "render/core/random.h"
#include "render/path/full_path.h"

namespace h2mc {

// Edges as bits: bit i for the one between x_(i-1) and x_i, 1 <= i <= k.
using EdgeMask = std::uint64_t;
inline constexpr EdgeMask kNoEdge = 0, kAllEdges = ~EdgeMask(0);
constexpr EdgeMask edgeBit(int i) { return EdgeMask(1) << i; }

// Makes `path` the given path in the given technique, with all that tracePath fills in. Non-delta lobes are
// drawn with the probability lobePdf / pdf, choice coordinates uniformly in the intervals of lobe, light and
// primitive, coordinates that nothing depends on uniformly: given path and technique that is how the
// primary space's own measure distributes them, so that a target w_i f / p_i stays what it is.
//
// Casts shadow rays along the edges of `cast` only; all others are taken to be free. The vertices are those
// to which the sample leads on the frozen topology, within rounding of the given ones: each scattering is aimed
// anew from where the path really is.
//
// False: the technique has no sample for the path, or rounding leads the sample elsewhere, the path carries
// nothing, or one of the edges is blocked. What is in `path` then means nothing.
// Preconditions: technique.length() == full.edges, `path` is made for that length at least. Never allocates.
bool assemble(const Scene& scene, const FullPath& full, Technique technique, EdgeMask cast,
              Random& random, Path& path);

// Whether the edge between x_(i-1) and x_i is free, and for i = k within the camera's view. One ray.
bool edgeVisible(const Scene& scene, const FullPath& full, int i);

}  // namespace h2mc
