// SPDX-License-Identifier: MIT
#include "scene_words.h"

#include <algorithm>

#include "mcmc/render/integrators.h"
#include "render/bsdf/bsdf.h"
#include "render/light/light.h"
#include "render/scene/sensor_plugins.h"
#include "render/scene/shape_plugins.h"
#include "render/texture/texture.h"

namespace h2mc::fuzz {
namespace {

using enum ParameterType;

// Samplers of all kinds are read alike: the reader has no table of them.
constexpr Parameter kSampler[] = {{"sampleCount", kInteger, "4", ""}};

std::vector<ElementType> makeElementTypes() {
  std::vector<ElementType> all;
  for (const BsdfPlugin& p : bsdfPlugins())
    all.push_back({"bsdf", p.name, p.parameters, p.nestedBsdfs});
  for (const auto& p : lightPlugins()) all.push_back({"emitter", p.name, p.parameters});
  for (const auto& p : shapePlugins()) all.push_back({"shape", p.name, p.parameters});
  for (const auto& p : texturePlugins()) all.push_back({"texture", p.name, p.parameters});
  for (const IntegratorFactory& f : allIntegrators())
    all.push_back({"integrator", f.plugin.name, f.plugin.parameters});
  for (const SensorPlugin& p : sensorPlugins()) all.push_back({"sensor", p.name, p.parameters});
  for (const SensorPlugin& p : filmPlugins()) all.push_back({"film", p.name, p.parameters});
  for (const SensorPlugin& p : filterPlugins()) all.push_back({"rfilter", p.name, p.parameters});
  all.push_back({"sampler", "independent", kSampler});
  return all;
}

std::string oneOf(std::string_view choices, Random& random) {
  std::vector<std::string> all{""};
  for (const char c : choices) {
    if (c == '|')
      all.emplace_back();
    else
      all.back() += c;
  }
  return random.pick(all);
}

std::string anyColor(Random& random) {
  switch (random.below(5)) {
    case 0:
      return anyNumber(random);
    case 1:
      return "#3f7fa0";
    case 2:
      return "400:" + anyNumber(random) + ", 700:" + anyNumber(random);
    default:
      return numbers(3, ", ", random);
  }
}

XmlElement makeColor(const std::string& name, Random& random) {
  constexpr std::string_view kElements[] = {"rgb", "rgb", "srgb", "spectrum", "float"};
  if (random.chance(0.05))
    return makeElement("blackbody", {{"name", name}, {"temperature", anyNumber(random)}});
  const std::string element(random.pick(kElements));
  return makeElement(
      element,
      {{"name", name}, {"value", element == "float" ? anyNumber(random) : anyColor(random)}});
}

XmlElement makeTransform(const std::string& name, Random& random) {
  XmlElement transform = makeElement("transform", {{"name", name}});
  for (std::size_t steps = 1 + random.below(3); steps > 0; --steps)
    transform.children.push_back(makeTransformStep(random));
  if (random.chance(0.8)) return transform;
  XmlElement animation = makeElement("animation", {{"name", name}});
  for (const char* time : {"0", "1"}) {
    XmlElement key = makeElement("transform", {{"time", time}});
    key.children.push_back(makeTransformStep(random));
    animation.children.push_back(key);
  }
  return animation;
}

// One that it can read.
std::string_view fileFor(const ElementType& type, Random& random) {
  constexpr std::string_view kPictures[] = {"picture.png", "sky.hdr", "sky.exr"};
  if (type.type == "obj") return "mesh.obj";
  if (type.type == "ply") return "mesh.ply";
  if (type.type == "serialized") return "mesh.serialized";
  return random.pick(kPictures);
}

std::string anyWord(const Parameter& parameter, Random& random) {
  if (!parameter.choices.empty()) return oneOf(parameter.choices, random);
  if (parameter.name == "filename") return std::string(random.pick(sceneFiles()));
  constexpr std::string_view kWords[] = {"bk7",  "air", "water", "diamond", "Al", "Au", "Cu",
                                         "none", "",    "50mm",  "1e-3mm",  "r",  "a",  "y"};
  if (random.chance(0.3)) return anyNumber(random);
  return std::string(random.chance(0.5) ? parameter.fallback : random.pick(kWords));
}

}  // namespace

std::span<const ElementType> elementTypes() {
  static const std::vector<ElementType> all = makeElementTypes();
  return all;
}

const ElementType* typeOf(const XmlElement& element) {
  for (const ElementType& t : elementTypes())
    if (t.element == element.name && t.type == element.attribute("type")) return &t;
  return nullptr;
}

const ElementType& anyTypeOf(std::string_view element, Random& random) {
  std::vector<const ElementType*> all;
  for (const ElementType& t : elementTypes())
    if (t.element == element) all.push_back(&t);
  return *random.pick(all);
}

std::span<const std::string_view> sceneFiles() {
  static constexpr std::string_view kFiles[] = {
      "mesh.obj", "mesh.ply",  "mesh.serialized", "picture.png", "sky.hdr",
      "sky.exr",  "curve.spd", "included.xml",    "input.xml",   "missing.obj"};
  return kFiles;
}

XmlElement makeElement(std::string name,
                       std::vector<std::pair<std::string, std::string>> attributes) {
  XmlElement element;
  element.name = std::move(name);
  for (auto& [key, value] : attributes) element.attributes.push_back({key, value, 0, 0});
  return element;
}

std::string anyNumber(Random& random) {
  constexpr std::string_view kTame[] = {"0",   "1",   "0.5",  "0.1", "0.05", "2",   "1.5",
                                        "0.8", "0.2", "0.01", "3",   "-1",   "0.3", "10"};
  return random.chance(0.8) ? std::string(random.pick(kTame)) : wildNumber(random);
}

std::string numbers(std::size_t count, std::string_view separator, Random& random) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += (i ? std::string(separator) : "") + anyNumber(random);
  return text;
}

XmlElement makeParameter(const Parameter& parameter, Random& random) {
  const std::string name(parameter.name);
  const bool standard = !parameter.fallback.empty() && random.chance(0.15);
  const auto plain = [&](const char* element, std::string value) {
    return makeElement(
        element, {{"name", name}, {"value", standard ? std::string(parameter.fallback) : value}});
  };
  switch (parameter.type) {
    case kBoolean:
      return plain("boolean", random.chance(0.5) ? "true" : "false");
    case kInteger:
      return plain("integer",
                   random.chance(0.8) ? std::to_string(random.below(12)) : wildNumber(random));
    case kNumber:
      return plain("float", anyNumber(random));
    case kString:
      return plain("string", anyWord(parameter, random));
    case kColor:
      return makeColor(name, random);
    case kTexture: {
      if (random.chance(0.7)) return makeColor(name, random);
      XmlElement texture = makeTyped(anyTypeOf("texture", random), random);
      texture.attributes.push_back({"name", name, 0, 0});
      return texture;
    }
    case kPoint:
    case kVector:
      return makeElement(parameter.type == kPoint ? "point" : "vector", {{"name", name},
                                                                         {"x", anyNumber(random)},
                                                                         {"y", anyNumber(random)},
                                                                         {"z", anyNumber(random)}});
    case kTransform:
      return makeTransform(name, random);
  }
  return makeElement("string", {{"name", name}, {"value", ""}});
}

XmlElement makeTransformStep(Random& random) {
  const auto triple = [&](std::string name) {
    return makeElement(
        std::move(name),
        {{"x", anyNumber(random)}, {"y", anyNumber(random)}, {"z", anyNumber(random)}});
  };
  switch (random.below(6)) {
    case 0:
    case 1:
      return triple("translate");
    case 2:
      return makeElement("scale", {{"value", anyNumber(random)}});
    case 3: {
      XmlElement rotate = triple("rotate");
      rotate.attributes.push_back({"angle", anyNumber(random) + "0", 0, 0});
      return rotate;
    }
    case 4:
      return makeElement("lookat", {{"origin", numbers(3, ", ", random)},
                                    {"target", numbers(3, ", ", random)},
                                    {"up", "0, 1, 0"}});
    default:
      return makeElement("matrix", {{"value", numbers(16, " ", random)}});
  }
}

XmlElement makeTyped(const ElementType& type, Random& random) {
  XmlElement element = makeElement(std::string(type.element), {{"type", std::string(type.type)}});
  for (const Parameter& p : type.parameters) {
    const bool needed = p.fallback.empty() && p.type == kString && !p.ignored;
    if (needed || random.chance(0.2)) element.children.push_back(makeParameter(p, random));
  }
  const std::string_view file = fileFor(type, random);
  for (XmlElement& child : element.children)
    if (child.attribute("name") == "filename" && random.chance(0.9))
      child.attributes.back().value = file;
  for (int i = 0; i < std::min(type.nestedBsdfs, 2); ++i)
    element.children.push_back(
        makeTyped(random.chance(0.1) ? anyTypeOf("bsdf", random) : elementTypes().front(), random));
  if (element.name == "shape" && random.chance(0.2))
    element.children.push_back(makeElement("emitter", {{"type", "area"}}));
  return element;
}

std::string xmlText(const XmlElement& element) {
  std::string text = "<" + element.name;
  for (const XmlAttribute& a : element.attributes) {
    text += " " + a.name + "=\"";
    for (const char c : a.value) {
      switch (c) {
        case '&':
          text += "&amp;";
          break;
        case '<':
          text += "&lt;";
          break;
        case '"':
          text += "&quot;";
          break;
        default:
          text += c;
      }
    }
    text += "\"";
  }
  if (element.children.empty()) return text + "/>\n";
  text += ">\n";
  for (const XmlElement& child : element.children) text += xmlText(child);
  return text + "</" + element.name + ">\n";
}

}  // namespace h2mc::fuzz
