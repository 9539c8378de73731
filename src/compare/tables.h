// SPDX-License-Identifier: MIT
// A comparison's results in tables where each row is one observation, for statistics and plotting.
#pragma once

#include <string>
#include <vector>

#include "compare/results.h"

namespace h2mc {

// One row for each image: scene, method, repeat, mark, time, mutations, all errors, file.
std::string resultsCsv(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// One row for each image and metric.
std::string errorsCsv(const std::vector<SceneResults>& results);

// One row for each method, metric and axis: error at equal time or work with its interval, slope, ratios, rank,
// verdict. What is not known is empty.
std::string summaryCsv(const std::vector<SceneResults>& results);

}  // namespace h2mc
