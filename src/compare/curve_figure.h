// SPDX-License-Identifier: MIT
// Error curves for papers.
#pragma once

#include "compare/curves.h"
#include "compare/figure.h"
#include "compare/results.h"

namespace h2mc {

// A method's colour, the same in every figure.
FigureColor methodColor(std::size_t method);

// The scene's errors in the main metric, against seconds or mutations a pixel, both axes logarithmic, one column wide.
// Line: geometric mean of the repeats; band: MethodCurve's.
Figure curveFigure(const SceneResults& scene, bool timed);

}  // namespace h2mc
