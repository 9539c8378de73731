// SPDX-License-Identifier: MIT
// What `h2mc inspect` found, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "inspect/inspect.h"
#include "render/image/image.h"

namespace h2mc {

// How arrays of numbers stand in the JSON.
enum class ArrayForm : std::uint8_t {
  kNumbers,  // as lists; slices of the chosen pair alone
  kBase64,  // as base64 of little-endian numbers: float for offsets, half for slices, bytes for cells
};

// Everything: the path, the local model with its eigenvectors, slices and proposals. Logarithms are
// natural; null in a slice (-65504 as a half): no contribution.
nlohmann::json inspectionJson(const Scene& scene, const Inspection& inspection,
                              const OptionSet& options, const InspectSettings& settings,
                              ArrayForm form);

// The path, the table of eigenvectors and that of mutations, in plain text.
std::string inspectionTable(const Scene& scene, const Inspection& inspection,
                            const OptionSet& options);

// A page that needs nothing else, from JSON with base64 arrays.
std::string inspectionPage(const nlohmann::json& report);

}  // namespace h2mc
