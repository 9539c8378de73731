#include "render/scene/scene_reader.h"

#include <fmt/format.h>

#include "render/scene/element_properties.h"
#include "render/scene/normalise.h"
#include "render/scene/part_readers.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

bool isOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void checkVersion(const XmlElement& root) {
  root.allowAttributes({"version"});
  const std::string version = root.attribute("version");
  if (version.empty()) return;  // taken for a recent one
  if (version.find_first_not_of("0123456789.") != std::string::npos)
    throw sourceError(root.place("version"), "\"" + version + "\" is not a version",
                      "expected a version like 0.6.0 or 3.0.0");
}

// What is not used is checked all the same: names and types, but no files.
void checkUnused(ReaderContext& context, const XmlElement& element) {
  if (element.name == "texture") {
    const auto& plugin = findPlugin(texturePlugins(), element, "texture");
    const ElementProperties check(context, element, {"texture", plugin.parameters, 0, {}, false});
  } else if (element.name == "bsdf") {
    const BsdfPlugin& plugin = findPlugin(bsdfPlugins(), element, "bsdf");
    const int nested = plugin.create ? plugin.nestedBsdfs : 2;
    const ElementProperties check(context, element, {"bsdf", plugin.parameters, nested, {}, false});
  }
  for (const XmlElement& child : element.children) checkUnused(context, child);
}

[[noreturn]] void rejectTopLevel(const XmlElement& element) {
  if (isOneOf(element.name, {"medium", "phase", "volume", "subsurface"}))
    throw sourceError(element.place(), "participating media are not supported");
  if (isOneOf(element.name, {"film", "rfilter", "sampler"}))
    throw sourceError(element.place(), "<" + element.name + "> outside a <sensor>");
  const Names names = {"bsdf",       "default", "dpt",   "emitter", "include",
                       "integrator", "sensor",  "shape", "texture"};
  throw sourceError(element.place(), "<" + element.name + "> inside <scene>",
                    "expected an element that belongs here; " + suggestion(element.name, names));
}

// Leaves out the materials that were only read to be put inside others.
void keepUsedMaterials(Scene& scene) {
  std::vector<int> index(scene.materials.size(), -1);
  for (const Shape& shape : scene.shapes) index[static_cast<std::size_t>(shape.material)] = 0;
  std::vector<Material> kept;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(scene.materials[i]));
  }
  scene.materials = std::move(kept);
  for (Shape& shape : scene.shapes)
    shape.material = index[static_cast<std::size_t>(shape.material)];
}

// What a user who looks at coordinates or targets should know.
void noteUnits(ReaderContext& context) {
  const Scene& scene = context.scene;
  if (scene.origin != glm::dvec3(0))
    context.note(fmt::format("far from the origin: coordinates are relative to ({}, {}, {})",
                             scene.origin.x, scene.origin.y, scene.origin.z));
  if (scene.radianceUnit != 1)
    context.note(
        fmt::format("computed in units of {} of the scene's radiance", scene.radianceUnit));
}

}  // namespace

Scene readScene(const std::string& file, const ReadOptions& options) {
  return makeScene(*loadSceneDocument(file, options.defines), options);
}

Scene makeScene(SceneDocument& document, const ReadOptions& options) {
  checkVersion(document.root);
  Scene scene;
  scene.file = document.root.file->name;
  const SceneUnits units = normalise(document);
  scene.origin = units.origin;
  scene.radianceUnit = units.radiance;
  ReaderContext context(document, scene);
  noteUnits(context);

  const XmlElement* sensor = nullptr;
  const XmlElement* integrator = nullptr;
  const XmlElement* dpt = nullptr;
  const auto once = [](const XmlElement*& slot, const XmlElement& element, const char* what) {
    if (slot)
      throw sourceError(element.place(), std::string("a second ") + what,
                        "first at " + describe(slot->place()));
    slot = &element;
  };
  for (const XmlElement& child : document.root.children) {
    if (child.name == "sensor" || child.name == "camera") {
      once(sensor, child, "camera");
    } else if (child.name == "integrator") {
      once(integrator, child, "integrator");
    } else if (child.name == "dpt") {
      once(dpt, child, "<dpt>");
    } else if (!isOneOf(child.name, {"shape", "emitter", "luminaire", "bsdf", "texture"})) {
      rejectTopLevel(child);
    }
  }
  if (integrator) readIntegrator(context, *integrator, options.integrators);
  if (dpt) readDptBlock(context, *dpt, options.integrators);
  if (sensor) readSensor(context, *sensor, options);
  for (const XmlElement& child : document.root.children) {
    if (child.name == "shape") readShape(context, child);
    if (child.name == "emitter" || child.name == "luminaire") readLight(context, child);
  }
  for (const XmlElement& child : document.root.children) {
    if (child.name != "bsdf" && child.name != "texture") continue;
    if (context.isUsed(child)) continue;
    checkUnused(context, child);
    const std::string id = child.attribute("id");
    context.note("left out: nothing refers to " + child.name + " " +
                 (id.empty() ? "at " + describe(child.place()) : "\"" + id + "\""));
  }
  if (!sensor)
    throw sourceError(document.root.place(), "the scene has no camera",
                      "expected <sensor type=\"perspective\">");
  if (scene.lights.empty())
    throw sourceError(document.root.place(), "the scene has no light",
                      "expected an <emitter> that emits something");
  keepUsedMaterials(scene);
  scene.finish();
  return scene;
}

}  // namespace h2mc
