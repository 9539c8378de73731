// SPDX-License-Identifier: MIT
// Renders what a comparison needs, and finds again what has been rendered.
#pragma once

#include "compare/observer.h"
#include "compare/setup.h"

namespace h2mc {

// Renders with marks, writes the images and, last, the record DIR/runs/SCENE/METHOD/.../record.json.
// A run whose record is there, with the same key (program version, scene file, size, defines,
// integrator, options, seed, threads, marks), is read instead. Repeats are the outer loop and the
// methods' order rotates, so that a machine that slows down hurts all alike.
// Returns false when it was stopped; the records of finished runs stay.
bool renderRuns(const ComparisonPlan& plan, const ComparisonSetup& setup,
                const ComparisonObserver& observer, std::vector<SceneRuns>& results);

}  // namespace h2mc
