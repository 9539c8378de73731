// SPDX-License-Identifier: MIT
#include "render/core/index.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"

namespace h2mc {

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
  if (!(std::visit([](const auto& l) { return l.power(SceneBounds()); }, light) > 0)) {
    const std::string on = shape < 0 ? "" : " on shape \"" + scene.shapes[at(shape)].name + "\"";
    context.note("left out: emitter \"" + std::string(plugin.name) + "\"" + on + " emits nothing");
    return -1;
  }
  const int index = static_cast<int>(scene.lights.size());
  if (std::visit([](const auto& l) { return l.isEnvironment(); }, light)) {
    if (scene.environment >= 0)
      throw sourceError(element.place(), "a second environment",
                        "expected at most one emitter \"constant\" or \"envmap\"");
    scene.environment = index;
  }
  scene.lights.push_back(std::move(light));
  return index;
}

void readLight(ReaderContext& context, const XmlElement& element) {
  addLight(context, element, -1);
}

}  // namespace h2mc
