// SPDX-License-Identifier: MIT
#include "mcmc/render/integrator_choice.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "mcmc/methods/presets.h"
#include "mcmc/render/integrators.h"
#include "render/core/types.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

constexpr const char* kDefaultIntegrator = "h2mc";

struct Wish : NamedOptions {  // the name is an integrator's
  const Preset* preset = nullptr;
};

Wish parse(const std::string& text) {
  Wish wish{namedOptions(text)};
  if ((wish.preset = presetNamed(wish.name))) wish.name = wish.preset->method;
  return wish;
}

const IntegratorFactory& findFactory(const std::string& name) {
  Names names;
  for (const IntegratorFactory& factory : allIntegrators()) {
    if (factory.plugin.name == name) return factory;
    names.emplace_back(factory.plugin.name);
  }
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  throw OptionError("unknown integrator \"" + name + "\"; " + suggestion(name, names));
}

void apply(const Wish& wish, OptionSet& options) {
  if (wish.preset)
    for (const auto& [name, value] : wish.preset->options) options.set(name, std::string(value));
  for (const auto& [name, value] : wish.options) options.set(name, value);
}

// What the scene says, as far as the integrator has an option for it.
void applyScene(const Scene& scene, OptionSet& options) {
  if (scene.samplesPerPixel > 0)
    for (const char* name : {"samplesPerPixel", "mutationsPerPixel"})
      if (options.has(name)) options.set(name, std::to_string(scene.samplesPerPixel));
  for (const auto& [name, value] : scene.options)
    if (options.has(name)) options.set(name, value);
  if (options.integrator() != scene.integrator.integrator()) return;
  for (const auto& [name, value] : scene.integrator.values())
    if (scene.integrator.given(name)) options.set(name, value);
}

}  // namespace

NamedOptions namedOptions(const std::string& text) {
  NamedOptions named;
  const std::size_t colon = text.find(':');
  named.name = text.substr(0, colon);
  if (colon == std::string::npos) return named;
  for (std::size_t begin = colon + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string option = text.substr(begin, end - begin);
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw OptionError(fmt::format("{}: expected option=value, got \"{}\"", text, option));
    named.options.emplace_back(option.substr(0, equals), option.substr(equals + 1));
    begin = end + 1;
  }
  return named;
}

IntegratorChoice chooseIntegrator(const std::string& wishText, const Scene& scene) {
  const Wish wish = parse(wishText);
  std::string name = wish.name;
  if (name.empty()) name = scene.integrator.integrator();
  if (name.empty()) name = kDefaultIntegrator;
  const IntegratorFactory& factory = findFactory(name);

  OptionSet options(factory.plugin);
  applyScene(scene, options);
  apply(wish, options);
  if (options.has("maxDepth") && options.integer("maxDepth") > kMaxPathLength) {
    spdlog::warn("maxDepth {} is above what the renderer goes to: paths have at most {} edges",
                 options.integer("maxDepth"), kMaxPathLength);
    options.set("maxDepth", std::to_string(kMaxPathLength));
  }
  std::unique_ptr<Integrator> integrator = factory.create(options);
  return {std::move(options), std::move(integrator)};
}

std::string optionText(const OptionSet& options) {
  std::string text;
  for (const auto& [name, value] : options.values())
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
  return text;
}

void checkIntegratorWish(const std::string& text) {
  const Wish wish = parse(text);
  if (wish.name.empty()) return;
  OptionSet options(findFactory(wish.name).plugin);
  apply(wish, options);
}

}  // namespace h2mc
