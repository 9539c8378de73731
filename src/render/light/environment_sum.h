// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light.h"

namespace h2mc {

// One light for two that are constant or envmap: the sum of both. Of two pictures the one with fewer pixels is looked
// up at the other's.
Light sumOfEnvironments(const Light& a, const Light& b);

}  // namespace h2mc
