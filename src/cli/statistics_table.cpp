// SPDX-License-Identifier: MIT
#include "cli/statistics_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace h2mc {
namespace {

using nlohmann::json;
using Rows = std::vector<std::pair<std::string, const json*>>;  // label and content

// "meanLuminanceError" -> "mean luminance error"; what is no identifier stays.
std::string words(const std::string& name) {
  if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c); }))
    return name;
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(name[i]);
    const bool capital = std::isupper(c);
    const bool afterSmall = i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]));
    if (capital && afterSmall) text += ' ';
    text += static_cast<char>(capital && afterSmall ? std::tolower(c) : c);
  }
  return text;
}

std::string scalar(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return withSeparators(value.get<long long>());
  if (value.is_number()) {
    const double number = value.get<double>();
    const bool large = std::abs(number) >= 1e4 && std::abs(number) < 1e15;
    return large ? withSeparators(std::llround(number)) : fmt::format("{:.4g}", number);
  }
  if (value.is_null()) return "-";
  return value.dump();
}

bool isListOfScalars(const json& value) {
  return value.is_array() &&
         std::none_of(value.begin(), value.end(), [](const json& v) { return v.is_structured(); });
}

std::string list(const json& value) {
  std::string text;
  for (const json& v : value) text += (text.empty() ? "" : "  ") + scalar(v);
  return text.empty() ? "-" : text;
}

// The rows if the members are all objects of scalars.
bool asTable(const json& value, Rows& rows) {
  if (!value.is_structured() || value.empty()) return false;
  for (const auto& item : value.items()) {
    const json& v = item.value();
    if (!v.is_object() || v.empty()) return false;
    for (const json& member : v)
      if (member.is_structured()) return false;
    rows.emplace_back(value.is_array() ? "" : words(item.key()), &v);
  }
  return true;
}

std::string table(const Rows& rows, int indent) {
  // Columns in the order in which they turn up; names lead.
  std::vector<std::string> columns;
  for (const auto& [label, row] : rows)
    for (const auto& item : row->items())
      if (std::find(columns.begin(), columns.end(), item.key()) == columns.end())
        columns.push_back(item.key());
  std::stable_partition(columns.begin(), columns.end(), [](const std::string& c) {
    return c == "name" || c == "kind" || c == "level";
  });

  std::vector<std::vector<std::string>> cells(1);
  cells[0].push_back("");
  for (const std::string& column : columns) cells[0].push_back(words(column));
  for (const auto& [label, row] : rows) {
    std::vector<std::string> line{label};
    for (const std::string& column : columns)
      line.push_back(row->contains(column) ? scalar((*row)[column]) : "");
    cells.push_back(line);
  }

  std::string text;
  std::vector<std::size_t> widths(columns.size() + 1, 0);
  for (const auto& line : cells)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  for (const auto& line : cells) {
    std::string out(indent, ' ');
    for (std::size_t c = 0; c < line.size(); ++c) {
      if (widths[c] == 0) continue;
      const bool left = c == 0 || columns[c - 1] == "name" || columns[c - 1] == "kind";
      out += left ? fmt::format("{:<{}}  ", line[c], widths[c])
                  : fmt::format("{:>{}}  ", line[c], widths[c]);
    }
    out.erase(out.find_last_not_of(' ') + 1);
    text += out + "\n";
  }
  return text;
}

}  // namespace

std::string withSeparators(long long number) {
  std::string digits = std::to_string(number);
  const int first = number < 0 ? 1 : 0;
  for (int i = static_cast<int>(digits.size()) - 3; i > first; i -= 3) digits.insert(i, ",");
  return digits;
}

std::string statisticsTable(const json& statistics, int indent) {
  if (!statistics.is_structured()) return std::string(indent, ' ') + scalar(statistics) + "\n";
  // Plain values first, then what needs a heading.
  std::size_t width = 0;
  std::string text, sections;
  const auto isPlain = [](const json& v) { return !v.is_structured() || isListOfScalars(v); };
  for (const auto& item : statistics.items())
    if (isPlain(item.value())) width = std::max(width, words(item.key()).size());
  for (const auto& item : statistics.items()) {
    const json& value = item.value();
    const std::string name = words(item.key());
    const std::string margin(indent, ' ');
    Rows rows;
    if (isPlain(value))
      text += fmt::format("{}{:<{}}  {}\n", margin, name, width,
                          value.is_array() ? list(value) : scalar(value));
    else if (asTable(value, rows))
      sections += margin + name + "\n" + table(rows, indent + 2);
    else
      sections += margin + name + "\n" + statisticsTable(value, indent + 2);
  }
  return text + sections;
}

}  // namespace h2mc
