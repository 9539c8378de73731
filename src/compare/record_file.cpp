// SPDX-License-Identifier: MIT
#include "compare/record_file.h"

#include "render/core/input_file.h"

namespace h2mc {

nlohmann::json readRecordFile(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "record.json";
  if (!std::filesystem::exists(file)) return nullptr;
  const std::string text = InputFile(file.string(), kLargestText).whole();
  const nlohmann::json record = nlohmann::json::parse(text, nullptr, false);
  return record.is_discarded() ? nlohmann::json() : record;
}

}  // namespace h2mc
