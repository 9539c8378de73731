// SPDX-License-Identifier: MIT
#include "cli/look_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "cli/commands.h"

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

}  // namespace h2mc
