// What the images of a comparison are compared with.
#pragma once

#include <optional>

#include "compare/runs.h"
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

// Renders two independent halves, longer and longer, until the error of their mean, which their
// difference tells, is a tenth of the smallest error of the runs' last images, or the plan's time for
// it is over. Goes on with what an earlier call left in the runs' folder. Only `runs.methods` of
// the runs is read. Returns false when it was stopped.
bool renderReference(const ComparisonPlan& plan, const ComparisonSetup::OneScene& setup,
                     const SceneRuns& runs, const ComparisonObserver& observer,
                     Reference& reference);

// The integrator of automatic references: the plan's; else what stands in backquotes after the words
// "Reference integrator:" in the README beside the scene; else bdpt.
std::string referenceIntegrator(const ComparisonPlan& plan, const ComparedScene& scene);

}  // namespace h2mc
