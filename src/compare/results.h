// SPDX-License-Identifier: MIT
// A comparison's results as files for people and programs.
#pragma once

#include "compare/measure.h"
#include "compare/summary.h"

namespace h2mc {

// One scene with all that was found out about it.
struct SceneResults {
  SceneRuns runs;
  std::vector<BiasCheck> bias;      // one a method
  std::vector<Summary> byTime;      // one a metric
  std::vector<Summary> byMutation;  // likewise
};

// Precondition: measured.
SceneResults resultsOf(SceneRuns runs, const ComparisonPlan& plan, const Image& reference);

// For the main axis, the main metric first.
const std::vector<Summary>& mainSummaries(const SceneResults& scene, const ComparisonPlan& plan);

// The place where a summary compares, in words: "40 s".
std::string position(const Summary& summary);

// An image's path as the results have it: relative to the comparison's folder, where it lies below that.
std::string shownPath(const std::filesystem::path& path, const ComparisonPlan& plan);

// Everything. Numbers that are infinite are the text "inf", those that are not known null.
nlohmann::json resultsJson(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// The ranking for the terminal, for the main metric.
std::string textTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// "AMD EPYC ..., 2 threads", from the system.
std::string machineName();

}  // namespace h2mc
