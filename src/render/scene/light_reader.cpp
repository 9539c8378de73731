// SPDX-License-Identifier: MIT
#include <cmath>

#include "render/core/index.h"
#include "render/light/environment_sum.h"
#include "render/light/sky_plugins.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"

namespace h2mc {

namespace {

double radiusOf(const SkyDisc& disc) { return 2 * std::asin(std::sqrt(double(disc.height) / 2)); }
bool overlap(const SkyDisc& a, const SkyDisc& b) {
  return a.heightOf(b.direction) < 1 - std::cos(radiusOf(a) + radiusOf(b));
}

// Keeps a light that is on no shape. Of those that are seen by rays which leave the scene there is one but for suns.
int keepLight(ReaderContext& context, const XmlElement& element, Light light) {
  Scene& scene = context.scene;
  const int index = static_cast<int>(scene.lights.size());
  if (const auto* sun = std::get_if<SunLight>(&light)) {
    for (const Light& other : scene.lights)
      if (const auto* second = std::get_if<SunLight>(&other);
          second && overlap(sun->disc(), second->disc()))
        throw sourceError(element.place(), "a second sun, which overlaps the first",
                          "expected suns apart from each other");
  } else if (std::visit([](const auto& l) { return l.isEnvironment(); }, light)) {
    if (scene.environment >= 0) {
      Light& first = scene.lights[at(scene.environment)];
      first = sumOfEnvironments(first, light);
      context.note("several environments: rendered as one, their sum");
      return scene.environment;
    }
    scene.environment = index;
  }
  scene.lights.push_back(std::move(light));
  return index;
}

}  // namespace

int addLight(ReaderContext& context, const XmlElement& element, int shape) {
  Scene& scene = context.scene;
  const auto& plugin = findPlugin(lightPlugins(), element, "emitter");
  const ElementProperties properties(context, element,
                                     {"emitter", plugin.parameters, 0, {}, false});
  Light light = createLocated(properties, plugin.create);

  auto* area = std::get_if<AreaLight>(&light);
  if (area && shape < 0)
    throw sourceError(element.place("type"), "emitter \"area\" is not on a shape",
                      "expected it inside a <shape>");
  if (!area && shape >= 0)
    throw sourceError(element.place("type"),
                      "emitter \"" + std::string(plugin.name) + "\" on a shape",
                      "expected emitter \"area\", or the emitter outside the shape");
  if (area) {
    area->shape = shape;
    area->prepare(scene.shapes);
  }
  const auto emits = [](const Light& one) {
    return std::visit([](const auto& l) { return l.power(SceneBounds()); }, one) > 0;
  };
  // A "sunsky" is two.
  int sun = -1;
  if (plugin.name == "sunsky")
    if (Light second = createLocated(properties, sunOfSunsky); emits(second))
      sun = keepLight(context, element, std::move(second));
  if (!emits(light)) {
    if (sun >= 0) return sun;
    const std::string on = shape < 0 ? "" : " on shape \"" + scene.shapes[at(shape)].name + "\"";
    context.note("left out: emitter \"" + std::string(plugin.name) + "\"" + on + " emits nothing");
    return -1;
  }
  return keepLight(context, element, std::move(light));
}

void readLight(ReaderContext& context, const XmlElement& element) {
  addLight(context, element, -1);
}

}  // namespace h2mc
