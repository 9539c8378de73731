// SPDX-License-Identifier: MIT
// The target on a plane through a path's point in primary space.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "inspect/local_model.h"
#include "render/path/path.h"

namespace h2mc {

// What is found at a moved primary sample.
enum class SliceCell : std::uint8_t {
  kDark,            // no contribution: something is in the way, or the path goes elsewhere
  kSame,            // the path's own topology, the one that the derivative knows
  kOtherPrimitive,  // the same shapes and lobes, another of their triangles
  kOtherTopology,   // another shape, lobe or light
  kOutside,         // not in the primary space: a coordinate that is no angle has left [0, 1)
};

// resolution x resolution points at the cells' middles, row by row from the top, where y is largest;
// x runs from -halfX to halfX, y from halfY to -halfY.
struct Slice {
  double halfX = 0, halfY = 0;
  int resolution = 0;
  std::vector<float> logRatio;  // log(target there / target here); -infinity where there is none
  std::vector<SliceCell> cells;

  double x(int column) const { return halfX * ((2.0 * column + 1) / resolution - 1); }
  double y(int row) const { return halfY * (1 - (2.0 * row + 1) / resolution); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution) +
           static_cast<std::size_t>(column);
  }
};

// Traces the path's neighbours path + x * (first direction) + y * (second), with its discrete choices.
// Precondition: a positive target, orthonormal directions of path.dimension() coordinates. Ends early,
// with cells kDark, when `stop` is set.
Slice traceSlice(const Scene& scene, const Path& path, const Direction& first,
                 const Direction& second, double halfX, double halfY, int resolution, int threads,
                 const std::atomic<bool>* stop);

// How the topology of a traced path with a positive target differs from that of another.
SliceCell compareTopology(const Path& path, const Path& other);

}  // namespace h2mc
