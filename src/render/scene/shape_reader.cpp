// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/shape_plugins.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

bool isMedium(const XmlElement& element) {
  return element.name == "medium" || element.name == "subsurface";
}

// What is in a shape besides its parameters and its BSDF.
struct Parts {
  const XmlElement* emitter = nullptr;
  bool hasMedium = false;
  bool failed = false;  // something is wrong, which is among the problems
};

Parts partsOf(ReaderContext& context, const XmlElement& element) {
  Parts parts;
  const auto read = [&](const XmlElement& child) {
    if (child.name == "sensor")
      throw sourceError(child.place(), "sensors on shapes are not supported");
    const XmlElement& target = context.resolve(child);
    if (isMedium(target)) {
      parts.hasMedium = true;
      context.problems.refuse(child.place(),
                              "participating media and subsurface scattering are not supported",
                              "the shape is rendered as if it were empty");
    }
    if (!isEmitter(target)) return;
    if (parts.emitter)
      throw sourceError(child.place(), "a second emitter on a shape",
                        "first at " + describe(parts.emitter->place()));
    parts.emitter = &target;
  };
  for (const XmlElement& child : element.children) {
    try {
      read(child);
    } catch (const SceneError& e) {
      context.problems.add(e);
      parts.failed = true;
    }
  }
  return parts;
}

[[noreturn]] void unsupported(const XmlElement& element, const std::string& what) {
  Names names;
  for (const auto& plugin : shapePlugins()) names.emplace_back(plugin.name);
  throw sourceError(element.place("type"), what + " are not supported yet",
                    "expected a shape of its own; available: " + joined(names));
}

// Puts a shape, which has its name and material, into the scene.
void addShape(ReaderContext& context, const Parts& parts, Shape shape, ShapeGeometry made) {
  Scene& scene = context.scene;
  if (made.dropped > 0)
    context.note("left out: " + std::to_string(made.dropped) +
                 (made.dropped == 1 ? " triangle" : " triangles") + " without area of shape \"" +
                 shape.name + "\"");
  noteMotionError(context, shape.name, made.motionError);
  const auto* still = std::get_if<TriangleMesh>(&made.geometry);
  const auto* moving = std::get_if<MovingMesh>(&made.geometry);
  if ((still && still->triangles.empty()) || (moving && moving->triangles.empty())) {
    context.note("left out: shape \"" + shape.name + "\" has no area" +
                 (parts.emitter ? ", so its emitter emits nothing" : ""));
    return;
  }
  shape.geometry = std::move(made.geometry);
  scene.shapes.push_back(std::move(shape));
  if (parts.emitter)
    scene.shapes.back().light =
        addLight(context, *parts.emitter, static_cast<int>(scene.shapes.size()) - 1);
}

// Whether the element, or what it leads to, has a texture of a mesh's vertex colours.
bool asksForColors(ReaderContext& context, const XmlElement& written,
                   std::set<const XmlElement*>& seen) {
  const XmlElement& element = context.resolve(written);
  if (isTexture(element) &&
      isOneOf(lowerCase(element.attribute("type")), {"vertexcolors", "mesh_attribute"}))
    return true;
  if (!seen.insert(&element).second) return false;
  return std::any_of(element.children.begin(), element.children.end(),
                     [&](const XmlElement& child) { return asksForColors(context, child, seen); });
}

// While it lives, what is read is on the shape's mesh, if that has vertex colours and the shape asks for them: the
// mesh's points then have MeshPlaces for texture coordinates.
class OnColoredMesh {
 public:
  OnColoredMesh(ReaderContext& context, const XmlElement& element, Geometry& geometry)
      : context_(context) {
    if (auto* still = std::get_if<TriangleMesh>(&geometry)) prepare(element, *still);
    if (auto* moving = std::get_if<MovingMesh>(&geometry)) prepare(element, *moving);
  }
  ~OnColoredMesh() { context_.mesh = nullptr; }
  OnColoredMesh(const OnColoredMesh&) = delete;
  OnColoredMesh& operator=(const OnColoredMesh&) = delete;

 private:
  template <class Mesh>
  void prepare(const XmlElement& element, Mesh& mesh) {
    std::vector<Rgbf> colors;
    std::swap(colors, mesh.colors);
    std::set<const XmlElement*> seen;
    if (colors.empty() || !asksForColors(context_, element, seen)) return;
    std::size_t negative = 0;
    for (Rgbf& c : colors) {
      if (c.x >= 0 && c.y >= 0 && c.z >= 0) continue;
      ++negative;
      c = glm::max(c, Rgbf(0));
    }
    if (negative > 0)
      context_.problems.tolerate(
          element.place(), fmt::format("{} vertex colours of the mesh are negative", negative),
          "in files of version 0.x, and with --permissive, they are 0");
    mesh.placeColumns = MeshPlace::columnsFor(mesh.triangles.size());
    context_.mesh = std::make_shared<const MeshAttributes>(
        MeshAttributes{mesh.placeColumns, mesh.triangles, std::move(colors), mesh.uvs});
  }

  ReaderContext& context_;
};

constexpr int kMostBsdfs = 1 << 20;  // of one mesh, by names

bool isBsdf(ReaderContext& context, const XmlElement& child) {
  return child.name == "bsdf" || (isReference(child) && context.resolve(child).name == "bsdf");
}

// Whether the shape has several BSDFs, or one with a name, for the mesh file's materials.
bool namesBsdfs(ReaderContext& context, const XmlElement& element) {
  int count = 0;
  bool named = false;
  for (const XmlElement& child : element.children) {
    if (!isBsdf(context, child)) continue;
    ++count;
    named = named || child.find("name");
  }
  return count > 1 || named;
}

// Which of a shape's BSDFs the parts of its mesh have: the one of the material's name, else the one without
// a name. A single one is everything's, if no material has its name.
class NamedBsdfs {
 public:
  NamedBsdfs(ReaderContext& context, const ElementProperties& properties,
             const std::vector<ShapePart>& parts)
      : context_(context) {
    const int count = properties.nestedBsdfCount();
    for (int i = 0; i < count; ++i) {
      const XmlElement& child = properties.nestedElement(i);
      const std::string name = child.attribute("name");
      const auto uses = [&](const ShapePart& part) { return part.material == name; };
      const bool used = std::any_of(parts.begin(), parts.end(), uses);
      if (name.empty() || (count == 1 && !used)) {
        nameless_ = properties.nestedBsdf(i);
      } else if (used) {
        byName_[name] = properties.nestedBsdf(i);
      } else {
        context.problems.warn(child.place("name"),
                              "no material of the mesh is called \"" + name + "\"",
                              "the bsdf is not used");
      }
    }
  }

  int materialOf(const std::string& name, bool emits) const {
    if (const auto found = byName_.find(name); found != byName_.end()) return found->second;
    return nameless_ >= 0 ? nameless_ : context_.defaultMaterial(emits ? 0.f : 0.5f);
  }

 private:
  ReaderContext& context_;
  std::map<std::string, int> byName_;
  int nameless_ = -1;
};

}  // namespace

void noteMotionError(ReaderContext& context, const std::string& name, double error) {
  if (error > kChordError)
    context.note(fmt::format(
        "shape \"{}\" turns so far that in {} steps it is off by up to {:.2g} % of its size", name,
        kMaxMotionSegments, 100 * error));
}

void readShape(ReaderContext& context, const XmlElement& element) {
  const std::string type = lowerCase(element.require("type"));
  if (type == "shapegroup") return;
  if (type == "instance") {
    readInstance(context, element);
    return;
  }
  if (type == "hair") unsupported(element, "hair fibres");
  const auto& plugin = findPlugin(shapePlugins(), element, "shape");

  std::vector<std::string> objects = {"emitter", "luminaire", "medium", "subsurface", "sensor"};
  if (!plugin.create) objects.emplace_back("shape");
  const Parts parts = partsOf(context, element);
  const XmlElement* const emitter = parts.emitter;
  const bool byName = plugin.name == "obj" && namesBsdfs(context, element);
  const ElementProperties properties(
      context, element, {"shape", plugin.parameters, byName ? kMostBsdfs : 1, objects, false});
  if (parts.failed) return;
  Shape shape;
  shape.name = element.attribute("id");
  if (shape.name.empty()) {
    shape.name = std::string(plugin.name);
    for (const Parameter& p : plugin.parameters)
      if (p.name == "filename") shape.name += " " + properties.string("filename");
  }
  if (byName) {
    auto made = createLocated(properties, readObjParts);
    const NamedBsdfs bsdfs(context, properties, made);
    for (ShapePart& part : made) {
      Shape one = shape;
      if (!part.material.empty()) one.name += " " + part.material;
      one.material = bsdfs.materialOf(part.material, parts.emitter != nullptr);
      addShape(context, parts, std::move(one), std::move(part.shape));
    }
    return;
  }
  ShapeGeometry made =
      plugin.create ? createLocated(properties, plugin.create) : readDeforming(context, properties);
  if (parts.hasMedium && !emitter && properties.nestedBsdfCount() == 0)
    return;  // a border of nothing
  const OnColoredMesh onMesh(context, element, made.geometry);
  // As Mitsuba 0.6: a shape that names no BSDF is grey, a light that names none is black.
  shape.material = properties.nestedBsdfCount() > 0 ? properties.nestedBsdf(0)
                                                    : context.defaultMaterial(emitter ? 0.f : 0.5f);
  addShape(context, parts, std::move(shape), std::move(made));
}

}  // namespace h2mc
