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

// One row for each image: scene, method, repeat, mark, time, mutations, errors, file.
std::string resultsCsv(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// Everything. Numbers that are infinite are the text "inf", those that are not known null.
nlohmann::json resultsJson(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// A table for a paper, for the main metric: scenes in groups, a row for each method. Needs booktabs.
std::string latexTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// The same for the terminal.
std::string textTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// "AMD EPYC ..., 2 threads", from the system.
std::string machineName();

}  // namespace h2mc
