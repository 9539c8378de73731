// SPDX-License-Identifier: MIT
#pragma once

#include "render/scene/option_set.h"

namespace h2mc {

// For methods that run lens perturbations beside steps in primary space.
inline constexpr Parameter kLensProbabilityParameter = {
    "lensProbability", ParameterType::kNumber, "0.3",
    "share of lens perturbations among the steps that are not large"};

}  // namespace h2mc
