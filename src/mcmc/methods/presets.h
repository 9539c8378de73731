// SPDX-License-Identifier: MIT
// Methods as their papers have them, by a name of their own: so that nobody has to type six options to compare fairly.
#pragma once

#include <span>
#include <string_view>
#include <utility>

namespace h2mc {

// What -i NAME stands for: a method with these options, which go before the scene's and behind those of the command
// line.
struct Preset {
  std::string_view name, description;  // one line
  std::string_view method;
  std::span<const std::pair<std::string_view, std::string_view>> options;
};

std::span<const Preset> presets();

// By name; null if there is none.
const Preset* presetNamed(std::string_view name);

}  // namespace h2mc
