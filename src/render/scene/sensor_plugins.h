// SPDX-License-Identifier: MIT
// What kinds of cameras, films and reconstruction filters scene files may have.
#pragma once

#include <span>

#include "render/scene/plugin.h"

namespace h2mc {

struct SensorPlugin {
  std::string_view name;  // as in type="..."
  std::string_view description;
  std::span<const Parameter> parameters;
};

std::span<const SensorPlugin> sensorPlugins();
std::span<const SensorPlugin> filmPlugins();
std::span<const SensorPlugin> filterPlugins();

}  // namespace h2mc
