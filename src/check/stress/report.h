// SPDX-License-Identifier: MIT
// What stress found, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "check/stress/variations.h"

namespace h2mc {

// Everything as JSON: settings, `variations` in the order they were run, with the texts that replay
// their worst paths, and `leftOut`, those that change nothing in the scene. Numbers that are not there
// or not finite are null.
// `command`: the command line that looks at the same scene, without --only.
nlohmann::json stressReport(const StressSettings& settings,
                            const std::vector<VariationOutcome>& outcomes,
                            const std::string& command);

// The report as a table in plain text.
std::string stressTable(const nlohmann::json& report);

// What failed in a variation, a line each with what looks at it alone; "" if nothing did.
std::string stressFailures(const std::vector<VariationOutcome>& outcomes,
                           const std::string& command);

}  // namespace h2mc
