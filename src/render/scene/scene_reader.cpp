// SPDX-License-Identifier: MIT
#include "render/scene/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "render/core/index.h"
#include "render/scene/change_note.h"
#include "render/scene/element_properties.h"
#include "render/scene/normalise.h"
#include "render/scene/part_readers.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

void checkVersion(const XmlElement& root) {
  root.allowAttributes({"version"});
  const std::string version = root.attribute("version");
  if (version.empty()) return;  // taken for a recent one
  if (version.find_first_not_of("0123456789.") != std::string::npos)
    throw sourceError(root.place("version"), "\"" + version + "\" is not a version",
                      "expected a version like 0.6.0 or 3.0.0");
}

// Names and types, but no files, of an element that is not made, and of those inside it.
void check(ReaderContext& context, const XmlElement& element) {
  const auto checked = [&](const char* kind, std::span<const Parameter> parameters, int nested) {
    const ElementProperties properties(context, element, {kind, parameters, nested, {}, false});
  };
  try {
    if (isTexture(element)) {
      checked("texture", findPlugin(texturePlugins(), element, "texture").parameters, 0);
    } else if (element.name == "bsdf") {
      const BsdfPlugin& plugin = findPlugin(bsdfPlugins(), element, "bsdf");
      checked("bsdf", plugin.parameters, plugin.nestedBsdfs);
    } else if (isEmitter(element)) {
      checked("emitter", findPlugin(lightPlugins(), element, "emitter").parameters, 0);
    }
  } catch (const SceneError& e) {
    context.problems.add(e);
  }
  for (const XmlElement& child : element.children) check(context, child);
}

// All that some <ref> leads to.
void collectReferred(const SceneDocument& document, const XmlElement& element,
                     std::set<const XmlElement*>& referred) {
  if (isReference(element)) referred.insert(document.find(element.attribute("id")));
  for (const XmlElement& child : element.children) collectReferred(document, child, referred);
}

// What stands on top only for others to refer to; a sampler or a medium alone does nothing.
bool isForReference(const XmlElement& element) {
  return isOneOf(element.name, {"bsdf", "texture", "film", "rfilter", "sampler", "medium", "phase",
                                "volume", "spectrum", "subsurface"}) ||
         (isEmitter(element) && lowerCase(element.attribute("type")) == "area");
}

[[noreturn]] void rejectTopLevel(const XmlElement& element) {
  const Names names = {"bsdf",       "default", "dpt",   "emitter", "include",
                       "integrator", "sensor",  "shape", "texture"};
  throw sourceError(element.place(), "<" + element.name + "> inside <scene>",
                    "expected an element that belongs here; " + suggestion(element.name, names));
}

// Leaves out the materials that were only read to be put inside others.
void keepUsedMaterials(Scene& scene) {
  std::vector<int> index(scene.materials.size(), -1);
  for (const Shape& shape : scene.shapes) index[at(shape.material)] = 0;
  std::vector<Material> kept;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(scene.materials[i]));
  }
  scene.materials = std::move(kept);
  for (Shape& shape : scene.shapes) shape.material = index[at(shape.material)];
}

// What a user who looks at coordinates or targets should know.
void noteUnits(ReaderContext& context) {
  const Scene& scene = context.scene;
  const SourcePlace place = context.document.root.place();
  if (scene.origin != glm::dvec3(0)) {
    const std::string origin =
        fmt::format("({}, {}, {})", scene.origin.x, scene.origin.y, scene.origin.z);
    context.note("far from the origin: coordinates are relative to " + origin);
    context.note(changeNote(place, "coordinates", "as they are", "relative to " + origin));
  }
  if (scene.radianceUnit != 1) {
    context.note(
        fmt::format("computed in units of {} of the scene's radiance", scene.radianceUnit));
    context.note(changeNote(
        place, "what lights emit", "as it is",
        fmt::format("in units of {:g}, which the picture is multiplied with", scene.radianceUnit)));
  }
}

float farthest(const Vec3f& p) {  // coordinate from 0
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// Goes through what stands on top of a scene; what is wrong with one part does not keep it from reading
// the next.
class SceneReader {
 public:
  SceneReader(ReaderContext& context, const ReadOptions& options)
      : context_(context), options_(options), root_(context.document.root) {}

  void read() {
    attempt([&] { checkVersion(root_); });
    for (const StrayText& stray : context_.document.strays)
      attempt([&] {
        context_.problems.tolerate(stray.place, "text inside <" + stray.element + ">",
                                   "expected only elements; values are written as value=\"...\"");
      });
    noteUnits(context_);
    collectReferred(context_.document, root_, referred_);
    for (const XmlElement& child : root_.children) attempt([&] { sort(child); });
    if (integrator_) attempt([&] { readIntegrator(context_, *integrator_, options_.integrators); });
    if (dpt_) attempt([&] { readDptBlock(context_, *dpt_, options_.integrators); });
    if (sensor_)
      attempt([&] {
        readSensor(context_, *sensor_, options_);
        const Camera& camera = context_.scene.camera;
        checkExtent(*sensor_, "the camera",
                    std::max(farthest(eye(camera, 0)), farthest(eye(camera, 1))));
        checkAxes(*sensor_, camera);
      });
    for (const XmlElement& child : root_.children)
      attempt([&] {
        if (child.name == "shape") readShapeWithin(child);
        if (isEmitter(child) && !(isForReference(child) && referred_.count(&child)))
          readLight(context_, child);
      });
    for (const XmlElement& child : root_.children) leaveOut(child);
    attempt([&] { checkHiddenEmitters(); });
    if (!context_.problems.empty()) checkRest();
    if (!sensor_)
      context_.problems.add(sourceError(root_.place(), "the scene has no camera",
                                        "expected <sensor type=\"perspective\">"));
    if (context_.scene.lights.empty() && context_.problems.empty())
      context_.problems.add(sourceError(root_.place(), "the scene has no light", withoutLight()));
  }

 private:
  template <class Read>
  void attempt(Read read) {
    try {
      read();
    } catch (const SceneError& e) {
      context_.problems.add(e);
    }
  }

  static constexpr std::array<float, 2> kCentre{0.5f, 0.5f};  // of the aperture
  static Vec3f eye(const Camera& camera, float time) {
    return camera.poseOf(time, kCentre).position;
  }

  // Their lengths do not matter, but squares of 1e-25 are nothing in float, and those of 1e25 no number.
  static void checkAxes(const XmlElement& element, const Camera& camera) {
    for (const float time : {0.f, 1.f}) {
      const CameraPose<float> pose = camera.poseOf(time, kCentre);
      for (const Vec3f& axis : {pose.left, pose.up, pose.forward})
        if (!(std::abs(glm::length(axis) - 1) < 0.1f))
          throw sourceError(element.place(), "the camera's transform leaves nothing of its axes",
                            "expected one that moves and turns: a camera has no size");
    }
  }

  void readShapeWithin(const XmlElement& element) {
    const std::vector<Shape>& shapes = context_.scene.shapes;
    const std::size_t before = shapes.size();
    readShape(context_, element);
    for (std::size_t i = before; i < shapes.size(); ++i) checkExtent(element, shapes[i]);
  }

  void sort(const XmlElement& child) {
    if (child.name == "sensor" || child.name == "camera") {
      // Mitsuba 2 and 3 have many and take the first.
      if (sensor_ && !isOldVersion(root_) && root_.find("version"))
        context_.problems.warn(child.place(), "a second camera",
                               "the first one is rendered, at " + describe(sensor_->place()));
      else
        once(sensor_, child, "camera");
    } else if (child.name == "integrator") {
      // One that another refers to is rendered by way of that.
      if (!referred_.count(&child)) once(integrator_, child, "integrator");
    } else if (child.name == "dpt") {
      once(dpt_, child, "<dpt>");
    } else if (child.name != "shape" && !isEmitter(child) && !isForReference(child)) {
      rejectTopLevel(child);
    }
  }

  static void once(const XmlElement*& slot, const XmlElement& element, const char* what) {
    if (slot)
      throw sourceError(element.place(), std::string("a second ") + what,
                        "first at " + describe(slot->place()));
    slot = &element;
  }

  bool isUnreferred(const XmlElement& child) const {
    const bool group = child.name == "shape" && lowerCase(child.attribute("type")) == "shapegroup";
    return (group || isForReference(child)) && !isEmitter(child) && !referred_.count(&child);
  }

  // What nothing needs. It is checked all the same, but whatever is wrong with it does no harm.
  void leaveOut(const XmlElement& child) {
    const bool isMade = child.name == "bsdf" || child.name == "texture";
    const bool unneeded =
        isUnreferred(child) || (isMade && !context_.isUsed(child) && context_.problems.empty());
    if (!unneeded) return;
    context_.problems.doNoHarm(true);
    check(context_, child);
    context_.problems.doNoHarm(false);
    const std::string id = child.attribute("id");
    context_.note("left out: nothing refers to " + child.name + " " +
                  (id.empty() ? "at " + describe(child.place()) : "\"" + id + "\""));
  }

  // What mistakes have kept from being read, so that all of it is said at once.
  void checkRest() {
    for (const XmlElement& child : root_.children)
      if (!isUnreferred(child)) check(context_, child);
  }

  // Lamps are hidden by leaving out paths of one edge. One seen through a hole of a mask, or a pane, has more.
  void checkHiddenEmitters() {
    if (!context_.hidesEmitters.file) return;
    const Scene& scene = context_.scene;
    const bool masks = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& m) { return m.opacity != nullptr; });
    const bool panes = std::any_of(scene.bsdfs.begin(), scene.bsdfs.end(), [](const Bsdf& b) {
      const auto* further = std::get_if<FurtherBsdf>(&b);
      return further && std::holds_alternative<ThinDielectric>(further->bsdf);
    });
    if (masks || panes)
      context_.problems.refuse(context_.hidesEmitters,
                               std::string("hideEmitters in a scene with ") +
                                   (masks ? "masks" : "thin panes") + " is not supported",
                               "lamps are seen through them");
  }

  // What to do about it, and which lamps were there.
  std::string withoutLight() const {
    std::string hint = "expected an <emitter> that emits something";
    for (const std::string& note : context_.scene.notes)
      if (note.rfind("left out: ", 0) == 0) hint += "\n" + note;
    return hint;
  }

  ReaderContext& context_;
  const ReadOptions& options_;
  const XmlElement& root_;
  const XmlElement *sensor_ = nullptr, *integrator_ = nullptr, *dpt_ = nullptr;
  std::set<const XmlElement*> referred_;
};

}  // namespace

void checkExtent(const XmlElement& element, const std::string& what, float reach) {
  constexpr float kFarthest = 1e15f;
  if (!(reach <= kFarthest))
    throw sourceError(
        element.place(), fmt::format("{} reaches to a coordinate of {:.3g}", what, reach),
        fmt::format("expected coordinates up to {:.0g}: the scene in a larger unit", kFarthest));
}

void checkExtent(const XmlElement& element, const Shape& shape) {
  const SceneBounds bounds = boundsOf({&shape, 1});
  checkExtent(element, "shape \"" + shape.name + "\"", farthest(bounds.center) + bounds.radius);
}

Scene readSceneText(const std::string& text, const std::string& name, const ReadOptions& options) {
  return makeScene(*loadSceneDocument(name, options.defines, options.confine, &text), options);
}

Scene readScene(const std::string& file, const ReadOptions& options) {
  return makeScene(*loadSceneDocument(file, options.defines, options.confine), options);
}

Scene makeScene(SceneDocument& document, const ReadOptions& options) {
  Scene scene;
  scene.file = document.root.file->name;
  ReaderContext context(document, scene, options.strictness);
  if (document.problems.empty()) {
    const SceneUnits units = normalise(document);
    scene.origin = units.origin;
    scene.radianceUnit = units.radiance;
  }
  for (const SceneError& problem : document.problems) context.problems.add(problem);
  for (const SourcePlace& place : document.spoilt) context.problems.silence(place);
  SceneReader(context, options).read();
  context.problems.throwIfAny();
  scene.files.assign(document.files.begin(), document.files.end());
  keepUsedMaterials(scene);
  scene.finish();
  return scene;
}

}  // namespace h2mc
