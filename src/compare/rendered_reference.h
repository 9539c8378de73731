// SPDX-License-Identifier: MIT
// References that a comparison renders for itself.
#pragma once

#include "compare/observer.h"
#include "compare/reference.h"
#include "compare/setup.h"

namespace h2mc {

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
