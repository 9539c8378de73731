// Materials and textures of a scene file: twosided and mask, and whatever the tables list.
#include "render/scene/reader_context.h"

#include "render/scene/element_properties.h"

namespace h2mc {
namespace {

// Marks an element as being made, for as long as it lives.
class Open {
 public:
  Open(std::set<const XmlElement*>& open, const XmlElement& element) : open_(open), key_(&element) {
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

std::string nameOf(const XmlElement& element) {
  const std::string id = element.attribute("id");
  return id.empty() ? element.attribute("type") : id;
}

}  // namespace

void ReaderContext::note(const std::string& text) {
  if (noted_.insert(text).second) scene.notes.push_back(text);
}

const XmlElement& ReaderContext::resolve(const XmlElement& element) const {
  if (!isReference(element)) return element;
  const std::string& id = element.require("id");
  if (const XmlElement* target = document.find(id)) return *target;
  Names names;
  for (const auto& [name, target] : document.ids) names.push_back(name);
  throw sourceError(element.place("id"), "nothing has the id \"" + id + "\"",
                    "expected the id of an element of the scene; " + suggestion(id, names));
}

TexturePtr ReaderContext::texture(const XmlElement& written) {
  const XmlElement& element = resolve(written);
  if (const auto found = textures_.find(&element); found != textures_.end()) return found->second;
  const Open open(open_, element);
  used_.insert(&element);
  const auto& plugin = findPlugin(texturePlugins(), element, "texture");
  const ElementProperties properties(*this, element, {"texture", plugin.parameters, 0, {}, false});
  const TexturePtr made = createLocated(properties, plugin.create);
  textures_[&element] = made;
  return made;
}

int ReaderContext::material(const XmlElement& written) {
  const XmlElement& element = resolve(written);
  if (element.name != "bsdf")
    throw sourceError(written.place("id"), "<" + element.name + "> is not a bsdf");
  if (const auto found = materials_.find(&element); found != materials_.end()) return found->second;
  const Open open(open_, element);
  used_.insert(&element);
  const int index = makeMaterial(element);
  materials_[&element] = index;
  return index;
}

int ReaderContext::makeMaterial(const XmlElement& element) {
  const BsdfPlugin& plugin = findPlugin(bsdfPlugins(), element, "bsdf");
  Material material;
  if (plugin.create) {
    const ElementProperties properties(*this, element,
                                       {"bsdf", plugin.parameters, plugin.nestedBsdfs, {}, false});
    Bsdf bsdf = createLocated(properties, plugin.create);
    material.front = static_cast<int>(scene.bsdfs.size());
    scene.bsdfs.push_back(std::move(bsdf));
  } else if (plugin.name == "mask") {
    material = makeMask(element, plugin);
  } else {
    material = makeTwosided(element, plugin);
  }
  material.name = nameOf(element);
  material.plugin = std::string(plugin.name);
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

Material ReaderContext::makeTwosided(const XmlElement& element, const BsdfPlugin& plugin) {
  const ElementProperties properties(*this, element, {"bsdf", plugin.parameters, 2, {}, false});
  if (properties.nestedBsdfCount() == 0)
    throw sourceError(element.place(), "bsdf \"twosided\" without a bsdf inside",
                      "expected one <bsdf> for both sides, or two: front and back");
  Material material;
  material.twosided = true;
  for (int i = 0; i < properties.nestedBsdfCount(); ++i) {
    const Material& side = properties.material(properties.nestedBsdf(i));
    const XmlElement& place = properties.nestedElement(i);
    const bool transmits =
        side.opacity || std::visit([](const auto& b) { return b.transmits(); },
                                   scene.bsdfs[static_cast<std::size_t>(side.front)]);
    if (side.twosided || transmits)
      throw sourceError(place.place(), "bsdf \"" + side.plugin + "\" inside bsdf \"twosided\"",
                        side.twosided ? "expected a bsdf that has one side"
                                      : "expected a bsdf that does not let light through");
    (i == 0 ? material.front : material.back) = side.front;
  }
  if (material.back < 0) material.back = material.front;
  return material;
}

Material ReaderContext::makeMask(const XmlElement& element, const BsdfPlugin& plugin) {
  const ElementProperties properties(*this, element, {"bsdf", plugin.parameters, 1, {}, false});
  if (properties.nestedBsdfCount() == 0)
    throw sourceError(element.place(), "bsdf \"mask\" without a bsdf inside",
                      "expected <bsdf type=\"...\"> or <ref id=\"...\"/>");
  Material material = properties.material(properties.nestedBsdf(0));
  if (material.opacity)
    throw sourceError(properties.nestedElement(0).place(), "bsdf \"mask\" inside bsdf \"mask\"",
                      "expected a bsdf that is not a mask");
  material.opacity = properties.texture("opacity");
  if (const auto* constant = std::get_if<ConstantTexture>(material.opacity.get())) {
    const Rgbf c = constant->color;
    if (c.x >= 1 && c.y >= 1 && c.z >= 1) material.opacity = nullptr;
  }
  return material;
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
