// SPDX-License-Identifier: MIT
#pragma once

#include "render/scene/option_set.h"

namespace h2mc {

// For methods that run lens perturbations beside steps in primary space.
inline constexpr Parameter kLensProbabilityParameter = {
    "lensProbability", ParameterType::kNumber, "0.3",
    "share of lens perturbations among the steps that are not large"};

// For methods whose small step may be a second try.
inline constexpr Parameter kDelayedRejectionParameter = {
    "delayedRejection", ParameterType::kBoolean, "false",
    "whether the method's small step is tried where an isotropic one was refused, in its place "
    "[Rioux-Lavoie et al. 2020]; for mmlt a smaller isotropic one"};

}  // namespace h2mc
