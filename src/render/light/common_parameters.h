// SPDX-License-Identifier: MIT
// Parameters that more than one light has.
#pragma once

#include "render/scene/plugin.h"

namespace h2mc {

inline constexpr Parameter kSamplingWeightParameter{
    "samplingWeight",
    ParameterType::kNumber,
    "1",
    "how often the light is chosen in other renderers",
    "",
    "",
    true};

}  // namespace h2mc
