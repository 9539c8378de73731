// SPDX-License-Identifier: MIT
#include "render/scene/option_set.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "render/scene/suggestion.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// The value as it is kept: without blanks, words in lower case. Throws ValueError.
std::string normalised(const Parameter& parameter, const std::string& text) {
  std::string word(trimmed(text));
  switch (parameter.type) {
    case ParameterType::kBoolean:
      return parseBoolean(lowerCase(word)) ? "true" : "false";
    case ParameterType::kInteger: {
      const long long value = parseInteger(word);
      if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
        throw ValueError("\"" + word + "\" is too large an integer");
      return std::to_string(value);
    }
    case ParameterType::kNumber:
      parseNumber(word);
      return word;
    default:
      break;
  }
  if (parameter.choices.empty()) return word;
  Names choices;
  std::string_view rest = parameter.choices;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    choices.emplace_back(rest.substr(0, bar));
    if (lowerCase(choices.back()) == lowerCase(word)) return choices.back();
    rest = bar == std::string_view::npos ? "" : rest.substr(bar + 1);
  }
  throw ValueError("\"" + word + "\" is not one of the choices; " + suggestion(word, choices));
}

}  // namespace

OptionSet::OptionSet(const IntegratorPlugin& plugin)
    : name_(plugin.name), parameters_(plugin.parameters) {
  for (const Parameter& p : parameters_) values_[std::string(p.name)] = std::string(p.fallback);
}

bool OptionSet::has(std::string_view name) const {
  for (const Parameter& p : parameters_)
    if (p.name == name) return true;
  return false;
}

bool OptionSet::given(std::string_view name) const {
  const auto found = given_.find(name);
  return found != given_.end() && found->second;
}

void OptionSet::set(std::string_view name, const std::string& text) {
  for (const Parameter& p : parameters_) {
    if (p.name != name) continue;
    try {
      values_[std::string(name)] = normalised(p, text);
    } catch (const ValueError& e) {
      throw OptionError("option \"" + std::string(name) + "\" of integrator \"" + name_ +
                        "\": " + e.what());
    }
    given_[std::string(name)] = true;
    return;
  }
  Names names;
  for (const Parameter& p : parameters_) names.emplace_back(p.name);
  throw OptionError("integrator \"" + name_ + "\" has no option \"" + std::string(name) + "\"; " +
                    suggestion(name, names));
}

const Parameter& OptionSet::find(std::string_view name) const {
  for (const Parameter& p : parameters_)
    if (p.name == name) return p;
  throw std::logic_error("the table of integrator \"" + name_ + "\" has no option \"" +
                         std::string(name) + "\"");
}

bool OptionSet::boolean(std::string_view name) const { return string(name) == "true"; }

int OptionSet::integer(std::string_view name) const {
  return static_cast<int>(parseInteger(string(name)));
}

double OptionSet::number(std::string_view name) const { return parseNumber(string(name)); }

const std::string& OptionSet::string(std::string_view name) const {
  find(name);
  return values_.find(name)->second;
}

void requireRange(const OptionSet& options, std::string_view name, double low, double high) {
  const double value = options.number(name);
  if (value >= low && value <= high) return;
  const std::string expected = std::isinf(high) ? fmt::format("at least {:g}", low)
                                                : fmt::format("from {:g} to {:g}", low, high);
  throw OptionError(fmt::format("option \"{}\" of integrator \"{}\" is {:g}; expected {}", name,
                                options.integrator(), value, expected));
}

}  // namespace h2mc
