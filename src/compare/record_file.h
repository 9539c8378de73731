// SPDX-License-Identifier: MIT
// The records that runs and references leave beside their images.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace h2mc {

// What the folder's record.json holds; null where there is none, or no JSON in it. Throws InputFileError where it is
// there and can't be read.
nlohmann::json readRecordFile(const std::filesystem::path& folder);

}  // namespace h2mc
