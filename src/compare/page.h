// SPDX-License-Identifier: MIT
// The comparison's page: one HTML file that needs no network.
#pragma once

#include "compare/results.h"

namespace h2mc {

enum class EmbeddedImages { kNone, kLast, kAll };  // of the first repeat: no image, last mark, all

// The page's text. Pictures are embedded as half floats, scaled by a power of two so that they fit.
// `references`: one a scene. Throws ImageError.
std::string comparisonPage(const std::vector<SceneResults>& results, const ComparisonPlan& plan,
                           const std::vector<Image>& references, EmbeddedImages images);

}  // namespace h2mc
