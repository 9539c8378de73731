// SPDX-License-Identifier: MIT
#include "cli/look_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/commands.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

constexpr double kMostStops = 100;

double stopsOf(const std::string& text) {
  double stops = 0;
  const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(first, end, stops);
  if (error != std::errc() || last != end || !(std::abs(stops) <= kMostStops))
    throw InputError("--exposure: expected auto, or a number of stops from -100 to 100, got \"" +
                     text + "\"");
  return stops;
}

}  // namespace

void addLookOptions(CLI::App& command, LookOptions& options) {
  command
      .add_option("--exposure", options.exposure,
                  "Stops by which the picture is shown brighter, or auto: its geometric mean "
                  "becomes middle "
                  "grey. Default: 0")
      ->type_name("auto|EV");
  command
      .add_option("--tonemap", options.curve,
                  "The PNG's curve. srgb: values above 1 are clipped; filmic: they are rolled off. "
                  "Default: srgb")
      ->check(CLI::IsMember({"srgb", "filmic"}));
}

ToneMapping toneMapping(const LookOptions& options) {
  ToneMapping mapping;
  if (options.exposure == "auto")
    mapping.stops.reset();
  else if (!options.exposure.empty())
    mapping.stops = stopsOf(options.exposure);
  if (options.curve == "filmic") mapping.curve = ToneCurve::kFilmic;
  return mapping;
}

std::vector<std::string> layerKindNames() {
  std::vector<std::string> names;
  for (const LayerName& layer : layerNames()) names.emplace_back(layer.name);
  return names;
}

std::vector<LayerKind> layerKinds(const std::vector<std::string>& names) {
  std::vector<LayerKind> kinds;
  for (const std::string& name : names) {
    const auto& all = layerNames();
    const auto layer =
        std::find_if(all.begin(), all.end(), [&](const LayerName& l) { return l.name == name; });
    if (layer == all.end())
      throw InputError("--aov: unknown layer \"" + name + "\"; " +
                       suggestion(name, layerKindNames()));
    if (std::find(kinds.begin(), kinds.end(), layer->kind) == kinds.end())
      kinds.push_back(layer->kind);
  }
  return kinds;
}

}  // namespace h2mc
