// SPDX-License-Identifier: MIT
// The lights "sky", "sun" and "sunsky" of scene files.
#pragma once

#include <span>

#include "render/light/light.h"

namespace h2mc {

// As lightPlugins(); "sunsky" makes the sky.
std::span<const Plugin<Light>> skyPlugins();

// The sun of a "sunsky", from the same parameters.
Light sunOfSunsky(const Properties& properties);

}  // namespace h2mc
