// SPDX-License-Identifier: MIT
// An integrator's options: a table of parameters with the values that the scene or the command line
// gives them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "render/core/user_error.h"
#include "render/scene/plugin.h"

namespace h2mc {

struct IntegratorPlugin {
  std::string_view name;
  std::string_view description;
  std::span<const Parameter> parameters;  // booleans, integers, numbers, strings
};

// A value that does not fit its parameter; what() says what was expected and what there is.
class OptionError : public UserError {
 public:
  using UserError::UserError;
};

// Values as text, checked against the table when they are set.
class OptionSet {
 public:
  OptionSet() = default;
  explicit OptionSet(const IntegratorPlugin& plugin);

  const std::string& integrator() const { return name_; }
  bool has(std::string_view name) const;    // the table knows it
  bool given(std::string_view name) const;  // somebody set it
  // Throws OptionError for an unknown name or a value of the wrong type.
  void set(std::string_view name, const std::string& text);

  bool boolean(std::string_view name) const;
  int integer(std::string_view name) const;
  double number(std::string_view name) const;
  const std::string& string(std::string_view name) const;

  // Every option with the value in force, for image attributes and statistics.
  const std::map<std::string, std::string, std::less<>>& values() const { return values_; }

 private:
  const Parameter& find(std::string_view name) const;

  std::string name_;
  std::span<const Parameter> parameters_;
  std::map<std::string, std::string, std::less<>> values_;
  std::map<std::string, bool, std::less<>> given_;
};

// Throws OptionError unless the numeric option lies in [low, high].
void requireRange(const OptionSet& options, std::string_view name, double low, double high);

}  // namespace h2mc
