// SPDX-License-Identifier: MIT
// Statistics for people to read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace h2mc {

// Any JSON object as indented lines, `name  value` in columns. Objects in it become headings, and
// objects or arrays whose members are alike become tables. Names in camelCase are split into words.
std::string statisticsTable(const nlohmann::json& statistics, int indent = 0);

// 1234567 -> "1,234,567".
std::string withSeparators(long long number);

}  // namespace h2mc
