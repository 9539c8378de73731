// SPDX-License-Identifier: MIT
// Pictures side by side for papers.
#pragma once

#include "compare/curve_figure.h"
#include "compare/figure.h"
#include "compare/results.h"
#include "render/image/film_window.h"

namespace h2mc {

// The reference with frames, and a column for each method, with what is within the frames and its error; last the
// reference's. Two columns wide. images: each method's at the place where they are compared; one without pixels is
// left out. Precondition: there is an inset.
Figure stripFigure(const SceneResults& scene, const ComparisonPlan& plan, const Image& reference,
                   const std::vector<Image>& images, const std::vector<PixelRectangle>& insets);

}  // namespace h2mc
