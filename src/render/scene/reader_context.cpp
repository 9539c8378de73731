// SPDX-License-Identifier: MIT
// Materials and textures of a scene file, and what refers to them.
#include "render/scene/reader_context.h"

#include "render/scene/element_properties.h"

namespace h2mc {
namespace {

// Marks an element as being made, for as long as it lives.
class Open {
 public:
  Open(std::set<const XmlElement*>& open, const XmlElement& element) : open_(open), key_(&element) {
    constexpr std::size_t kDeepest = 64;  // what is made inside each other takes stack
    if (open_.size() >= kDeepest)
      throw sourceError(element.place("id"),
                        "references lead more than " + std::to_string(kDeepest) + " elements deep");
    if (!open_.insert(key_).second)
      throw sourceError(element.place("id"),
                        "<" + element.name + "> contains itself by a reference");
  }
  ~Open() { open_.erase(key_); }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;

 private:
  std::set<const XmlElement*>& open_;
  const XmlElement* key_;
};

}  // namespace

void ReaderContext::note(const std::string& text) {
  if (noted_.insert(text).second) scene.notes.push_back(text);
}

const XmlElement& ReaderContext::resolve(const XmlElement& element) {
  if (!isReference(element)) return element;
  const std::string& id = element.require("id");
  if (const XmlElement* target = document.find(id)) return *target;
  if (document.incomplete) problems.silence(element.place("id"));
  Names names;
  for (const auto& [name, target] : document.ids) names.push_back(name);
  throw sourceError(element.place("id"), "nothing has the id \"" + id + "\"",
                    "expected the id of an element of the scene; " + suggestion(id, names));
}

TexturePtr ReaderContext::texture(const XmlElement& written, bool texelsMayBeNegative) {
  const XmlElement& element = resolve(written);
  TexturePtr& made = textures_[{&element, texelsMayBeNegative, mesh}];
  if (made) return made;
  const Open open(open_, element);
  used_.insert(&element);
  const auto& plugin = findPlugin(texturePlugins(), element, "texture");
  const ElementProperties properties(
      *this, element, {"texture", plugin.parameters, 0, {}, false, texelsMayBeNegative});
  if (!plugin.create) return made = vertexColors(properties, plugin.name);
  made = createLocated(properties, plugin.create);
  // Others are the same everywhere, or made of textures that are on the mesh already.
  if (mesh && (std::holds_alternative<BitmapTexture>(*made) ||
               std::holds_alternative<CheckerboardTexture>(*made)))
    made = std::make_shared<const Texture>(MeshTexture{mesh, made});
  return made;
}

TexturePtr ReaderContext::vertexColors(const ElementProperties& properties,
                                       std::string_view plugin) {
  float scale = 1;
  if (plugin == "mesh_attribute") {
    if (const std::string name = properties.string("name"); name != "vertex_color")
      properties.fail(
          "name", properties.description() + ": the attribute \"" + name + "\" is not supported",
          "expected \"vertex_color\"");
    scale = properties.number("scale");
  }
  if (!mesh) {
    problems.refuse(properties.element().place(),
                    properties.description() + ": what it is on has no vertex colours",
                    "it is black there");
    return constantTexture(Rgbf(0));
  }
  auto colors = std::make_shared<const Texture>(MeshTexture{mesh, nullptr});
  if (scale == 1) return colors;
  return std::make_shared<const Texture>(ProductTexture{constantTexture(Rgbf(scale)), colors});
}

int ReaderContext::material(const XmlElement& written) {
  const XmlElement& element = resolve(written);
  if (element.name != "bsdf")
    throw sourceError(written.place("id"), "<" + element.name + "> is not a bsdf");
  if (const auto found = materials_.find({&element, mesh}); found != materials_.end())
    return found->second;
  const Open open(open_, element);
  used_.insert(&element);
  const int index = makeMaterial(element);
  materials_[{&element, mesh}] = index;
  return index;
}

int ReaderContext::defaultMaterial(float reflectance) {
  const auto [entry, isNew] = defaults_.try_emplace(reflectance, -1);
  if (!isNew) return entry->second;
  auto file = std::make_shared<SourceFile>();
  file->name = "(default)";
  XmlElement parameter;
  parameter.name = "float";
  parameter.attributes = {{"name", "reflectance", 0, 0},
                          {"value", std::to_string(reflectance), 0, 0}};
  parameter.file = file;
  XmlElement element;
  element.name = "bsdf";
  element.attributes = {{"type", "diffuse", 0, 0}};
  element.file = file;
  element.children.push_back(parameter);
  entry->second = makeMaterial(element);
  scene.materials.back().name = "default";
  return entry->second;
}

}  // namespace h2mc
