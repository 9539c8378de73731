// SPDX-License-Identifier: MIT
// What gradcheck found, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "check/gradcheck/gradcheck.h"

namespace h2mc {

// Everything as JSON: settings, totals, `groups` (rows by technique, BSDF, light, motion and origin),
// `histograms` of the errors, and `worst`, the paths to look at, with their replay text, their entries
// and the sweep of steps of the worst entry. Errors are null where nothing was judged.
nlohmann::json gradcheckReport(const Scene& scene, const GradcheckSettings& settings,
                               const GradcheckResult& result);

// The report's totals and groups as a table in plain text.
std::string gradcheckTable(const nlohmann::json& report);

// One path in full: vertices, and every entry with its difference, error and verdict.
std::string describePath(const Scene& scene, const SampledPath& sampled,
                         const GradcheckSettings& settings);

// A page that needs nothing else: tables, histograms, error against step size.
std::string gradcheckPage(const nlohmann::json& report);

}  // namespace h2mc
