// SPDX-License-Identifier: MIT
#include "check/stress/variations.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "render/integrator/parallel_rounds.h"
#include "render/scene/document_edit.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

std::vector<Variation> makeList() {
  std::vector<Variation> list = {{"as-is", "the scene as it is", {}}};
  const auto add = [&](const char* name, const char* value, const std::string& description,
                       std::function<int(SceneDocument&)> change) {
    list.push_back({fmt::format("{}={}", name, value), description, std::move(change)});
  };
  for (const char* alpha : {"1", "0.1", "0.01", "1e-3", "1e-4"})
    add("alpha", alpha, fmt::format("roughness {} of every rough material", alpha),
        [a = std::stod(alpha)](SceneDocument& d) { return setRoughness(d, a); });
  for (const char* exponent : {"1", "100", "1e4", "1e6"})
    add("exponent", exponent, fmt::format("exponent {} of every Phong material", exponent),
        [e = std::stod(exponent)](SceneDocument& d) { return setPhongExponent(d, e); });
  for (const char* index : {"1", "1.0001"})
    add("ior", index, fmt::format("refractive index {} of everything transparent or coated", index),
        [n = std::stod(index)](SceneDocument& d) { return setRefractiveIndex(d, n); });
  for (const char* scale : {"1e-4", "1e-2", "1e3", "1e6"})
    add("scale", scale, fmt::format("everything {} times as large", scale),
        [s = std::stod(scale)](SceneDocument& d) { return moveScene(d, s, glm::dvec3(0)); });
  add("moved", "1e6", "everything moved by (1e6, 1e6, 1e6)",
      [](SceneDocument& d) { return moveScene(d, 1, glm::dvec3(1e6)); });
  add("lights", "1e-6", "area lights of 1e-6 of their area and as much power as before",
      [](SceneDocument& d) { return shrinkLights(d, 1e-6); });
  for (const char* factor : {"1e-30", "1e30"})
    add("radiance", factor, fmt::format("lights {} times as bright", factor),
        [f = std::stod(factor)](SceneDocument& d) { return scaleRadiance(d, f); });
  list.push_back({"length=32", "paths of up to 32 edges", {}, kMaxPathLength});
  list.push_back({"u=0",
                  "primary coordinates at 0, one by one and together",
                  {},
                  0,
                  CoordinatePlacement::kZero});
  list.push_back({"u=1",
                  "primary coordinates at 1 - 2^-24, one by one and together",
                  {},
                  0,
                  CoordinatePlacement::kBelowOne});
  return list;
}

}  // namespace

std::span<const Variation> stressVariations() {
  static const std::vector<Variation> list = makeList();
  return list;
}

std::vector<const Variation*> chooseVariations(const std::vector<std::string>& names) {
  const auto family = [](const std::string& name) { return name.substr(0, name.find('=')); };
  for (const std::string& name : names) {
    const auto list = stressVariations();
    if (std::any_of(list.begin(), list.end(),
                    [&](const Variation& v) { return v.name == name || family(v.name) == name; }))
      continue;
    Names known;
    for (const Variation& v : list) known.push_back(v.name);
    throw std::invalid_argument("unknown variation \"" + name + "\"; " + suggestion(name, known));
  }
  std::vector<const Variation*> chosen;
  for (const Variation& v : stressVariations())
    if (names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
          return v.name == name || family(v.name) == name;
        }))
      chosen.push_back(&v);
  return chosen;
}

std::optional<Scene> makeVariation(const std::string& file, const ReadOptions& options,
                                   const Variation& variation, StressSettings& settings) {
  const auto document = loadSceneDocument(file, options.defines, options.confine);
  if (variation.change && variation.change(*document) == 0) return {};
  if (variation.maxLength > 0) settings.maxLength = variation.maxLength;
  settings.placement = variation.placement;
  return makeScene(*document, options);
}

VariationOutcome runVariation(const std::string& file, const ReadOptions& options,
                              const Variation& variation, StressSettings settings) {
  VariationOutcome outcome;
  outcome.variation = &variation;
  const double start = wallClock();
  try {
    const std::optional<Scene> scene = makeVariation(file, options, variation, settings);
    outcome.applies = scene.has_value();
    if (scene) outcome.findings = stressScene(*scene, settings);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    outcome.error = e.what();
  }
  outcome.seconds = wallClock() - start;
  return outcome;
}

}  // namespace h2mc
