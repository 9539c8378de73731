#include <iomanip>
#include <sstream>

#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/shape_plugins.h"

namespace h2mc {
namespace {

bool isEmitter(const XmlElement& element) {
  return element.name == "emitter" || element.name == "luminaire";
}

[[noreturn]] void unsupported(const XmlElement& element, const std::string& what) {
  Names names;
  for (const auto& plugin : shapePlugins()) names.emplace_back(plugin.name);
  throw sourceError(element.place("type"), what + " are not supported yet",
                    "expected a shape of its own; available: " + joined(names));
}

}  // namespace

void readShape(ReaderContext& context, const XmlElement& element) {
  Scene& scene = context.scene;
  const std::string type = lowerCase(element.require("type"));
  if (type == "shapegroup" || type == "instance")
    unsupported(element, "shape groups and instances");
  if (type == "hair") unsupported(element, "hair fibres");
  const auto& plugin = findPlugin(shapePlugins(), element, "shape");

  const XmlElement* emitter = nullptr;
  for (const XmlElement& child : element.children) {
    if (child.name == "medium" || child.name == "subsurface")
      throw sourceError(child.place(),
                        "participating media and subsurface scattering are not supported");
    if (child.name == "sensor")
      throw sourceError(child.place(), "sensors on shapes are not supported");
    const XmlElement& target = context.resolve(child);
    if (!isEmitter(target)) continue;
    if (emitter)
      throw sourceError(child.place(), "a second emitter on a shape",
                        "first at " + describe(emitter->place()));
    emitter = &target;
  }

  std::vector<std::string> objects = {"emitter", "luminaire"};
  if (!plugin.create) objects.emplace_back("shape");
  const ElementProperties properties(context, element,
                                     {"shape", plugin.parameters, 1, objects, false});
  ShapeGeometry made =
      plugin.create ? createLocated(properties, plugin.create) : readDeforming(context, properties);
  Shape shape;
  shape.name = element.attribute("id");
  if (shape.name.empty()) {
    shape.name = std::string(plugin.name);
    for (const Parameter& p : plugin.parameters)
      if (p.name == "filename") shape.name += " " + properties.string("filename");
  }
  if (made.dropped > 0)
    context.note("left out: " + std::to_string(made.dropped) +
                 (made.dropped == 1 ? " triangle" : " triangles") + " without area of shape \"" +
                 shape.name + "\"");
  if (made.motionError > kChordError) {
    std::ostringstream percent;
    percent << std::setprecision(2) << 100 * made.motionError;
    context.note("shape \"" + shape.name + "\" turns so far that in " +
                 std::to_string(kMaxMotionSegments) + " steps it is off by up to " + percent.str() +
                 " % of its size");
  }
  const auto* still = std::get_if<TriangleMesh>(&made.geometry);
  const auto* moving = std::get_if<MovingMesh>(&made.geometry);
  if ((still && still->triangles.empty()) || (moving && moving->triangles.empty())) {
    context.note("left out: shape \"" + shape.name + "\" has no area");
    return;
  }
  shape.geometry = std::move(made.geometry);
  // As Mitsuba 0.6: a shape that names no BSDF is grey, a light that names none is black.
  shape.material = properties.nestedBsdfCount() > 0 ? properties.nestedBsdf(0)
                                                    : context.defaultMaterial(emitter ? 0.f : 0.5f);
  scene.shapes.push_back(std::move(shape));
  if (emitter)
    scene.shapes.back().light =
        addLight(context, *emitter, static_cast<int>(scene.shapes.size()) - 1);
}

}  // namespace h2mc
