// Options that every integrator has.
#pragma once

#include <algorithm>
#include <limits>

#include "render/core/types.h"
#include "render/scene/option_set.h"
#include "render/scene/plugin.h"

namespace h2mc {

inline constexpr Parameter kMaxDepthParameter = {
    "maxDepth", ParameterType::kInteger, "-1",
    "longest path in edges (1: emitters seen directly); -1: as long as the renderer goes, 32"};
inline constexpr Parameter kMinDepthParameter = {"minDepth", ParameterType::kInteger, "1",
                                                 "shortest path in edges"};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The longest path for the option maxDepth. Throws OptionError for numbers that mean nothing.
inline int maxPathLength(const OptionSet& options) {
  const int maxDepth = options.integer("maxDepth");
  if (maxDepth == -1) return kMaxPathLength;
  requireRange(options, "maxDepth", 1, kNoLimit);
  return std::min(maxDepth, kMaxPathLength);
}

// The largest float below 1: film positions stay on the film when they are rounded.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace h2mc
