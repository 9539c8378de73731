// SPDX-License-Identifier: MIT
// Options that every integrator has.
#pragma once

#include <limits>

#include "render/core/types.h"
#include "render/core/unit_interval.h"
#include "render/scene/option_set.h"
#include "render/scene/plugin.h"

namespace h2mc {

inline constexpr Parameter kMaxDepthParameter = {
    "maxDepth", ParameterType::kInteger, "-1",
    "longest path in edges (1: emitters seen directly); -1: as long as the renderer goes, 32"};
inline constexpr Parameter kMinDepthParameter = {"minDepth", ParameterType::kInteger, "1",
                                                 "shortest path in edges"};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The longest path for the option maxDepth. Throws OptionError for numbers that mean nothing, and where minDepth leaves
// no paths.
int maxPathLength(const OptionSet& options);

}  // namespace h2mc
