// SPDX-License-Identifier: MIT
// A pair of directions as one picture.
#pragma once

#include "inspect/inspect.h"
#include "render/image/image.h"

namespace h2mc {

// The target, its quadratic approximation, and each mutation's proposals over the target, side by side,
// with axes, a colour bar and a legend. Large steps are drawn on the film: most of them go to other
// techniques. `slice` is one of the pair's.
Image drawPair(const Scene& scene, const Inspection& inspection, const InspectedPair& pair,
               const Slice& slice);

}  // namespace h2mc
