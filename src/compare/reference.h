// SPDX-License-Identifier: MIT
// What the images of a comparison are compared with.
#pragma once

#include <optional>

#include "compare/comparison.h"
#include "render/image/image.h"

namespace h2mc {

struct Reference {
  Image image;
  ReferenceFacts facts;
};

// The size to render at, where the scene's own is not the reference's (or a whole part of it) but has its
// proportions, and the plan has none.
std::optional<glm::ivec2> sizeForReference(const ComparisonPlan& plan, const ComparedScene& scene,
                                           int width, int height);

// The image that the plan names for the scene, averaged to the film's size where it is a whole multiple
// of it; its own error from "NAME_stderr.exr" beside it, if there is one.
// Throws ImageError, ComparisonError.
Reference givenReference(const ComparisonPlan& plan, const ComparedScene& scene, int width,
                         int height);

}  // namespace h2mc
