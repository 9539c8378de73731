// Options that every integrator has.
#pragma once

#include <algorithm>

#include "render/core/types.h"
#include "render/scene/plugin.h"

namespace h2mc {

inline constexpr Parameter kMaxDepthParameter = {
    "maxDepth", ParameterType::kInteger, "-1",
    "longest path in edges (1: emitters seen directly); -1: as long as the renderer goes, 32"};
inline constexpr Parameter kMinDepthParameter = {"minDepth", ParameterType::kInteger, "1",
                                                 "shortest path in edges"};

// The longest path for a maxDepth option.
inline int maxPathLength(int maxDepth) {
  return maxDepth < 0 ? kMaxPathLength : std::min(maxDepth, kMaxPathLength);
}

// The largest float below 1: film positions stay on the film when they are rounded.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace h2mc
