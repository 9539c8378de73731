// SPDX-License-Identifier: MIT
#include "render/scene/document_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "render/scene/color_reader.h"
#include "render/scene/element_properties.h"
#include "render/scene/suggestion.h"
#include "render/scene/transform_reader.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

std::string typeOf(const XmlElement& element) { return lowerCase(element.attribute("type")); }

// Whether a parameter is called so, in any of the spellings that the reader knows.
bool isCalled(const XmlElement& parameter, std::string_view name) {
  const std::string written = parameter.attribute("name");
  return !written.empty() && snakeCase(written) == snakeCase(name);
}

// The last one of that name, which counts for the reader. Element is XmlElement or const XmlElement.
template <class Element>
Element* findParameter(Element& element, std::string_view name) {
  const auto found = std::find_if(element.children.rbegin(), element.children.rend(),
                                  [&](const Element& child) { return isCalled(child, name); });
  return found == element.children.rend() ? nullptr : &*found;
}

std::string text(double x) { return fmt::format("{}", x); }
std::string text(const glm::dvec3& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

// Puts <kind name value> in the place of the parameter of that name, or beside the others.
// False if it is there with that value.
bool setParameter(XmlElement& element, const std::string& kind, const std::string& name,
                  const std::string& value) {
  XmlElement* const old = findParameter(element, name);
  if (old && old->name == kind && old->attribute("value") == value) return false;
  XmlElement made = makeElement(element, kind, {{"name", name}, {"value", value}});
  if (old)
    *old = std::move(made);
  else
    element.children.push_back(std::move(made));
  return true;
}

bool setNumber(XmlElement& element, const std::string& name, double value) {
  if (const XmlElement* const old = findParameter(element, name)) {
    try {
      if (parseNumber(old->attribute("value")) == value) return false;
    } catch (const ValueError&) {
      // A word, or nothing that can be read: replaced.
    }
  }
  return setParameter(element, "float", name, text(value));
}

void removeParameter(XmlElement& element, std::string_view name) {
  std::erase_if(element.children, [&](const XmlElement& child) { return isCalled(child, name); });
}

// Calls change(element) for every element, parents first, and counts how often it returned true.
int forAll(XmlElement& element, const std::function<bool(XmlElement&)>& change) {
  int changed = change(element);
  for (XmlElement& child : element.children) changed += forAll(child, change);
  return changed;
}

// The same for a document, whose ids are then looked up anew.
int edit(SceneDocument& document, const std::function<bool(XmlElement&)>& change) {
  const int changed = forAll(document.root, change);
  document.indexIds();
  return changed;
}

bool scaleColor(const SceneDocument& document, XmlElement& element, const std::string& name,
                double factor) {
  XmlElement* const given = findParameter(element, name);
  if (given && isTexture(*given)) {
    bool changed = false;
    if (typeOf(*given) == "checkerboard")
      for (const char* color : {"color0", "color1"})
        if (findParameter(*given, color)) changed |= scaleColor(document, *given, color, factor);
    return changed;
  }
  if (given && isReference(*given)) return false;
  const glm::dvec3 scaled = glm::dvec3(given ? readColor(document, *given) : Rgbf(1)) * factor;
  return setParameter(element, "rgb", name, text(scaled));
}

// What of a light of this type is multiplied; "" if it isn't a colour.
std::string colorOf(const std::string& type) {
  if (type == "point" || type == "spot") return "intensity";
  if (type == "directional") return "irradiance";
  if (type == "collimated") return "power";
  return type == "area" || type == "constant" ? "radiance" : "";
}

// Whether a light of this type has a number for that.
bool hasScale(const std::string& type) {
  return isOneOf(type, {"envmap", "sky", "sun", "sunsky", "projector"});
}

// Whether it stands at a point, so that what it sends in a direction grows with the world's area.
bool isAtPoint(const XmlElement& element) {
  return isEmitter(element) &&
         isOneOf(typeOf(element), {"point", "spot", "projector", "collimated"});
}

double scaleOf(const XmlElement& emitter, const char* name) {
  const XmlElement* const scale = findParameter(emitter, name);
  return scale ? readNumber(*scale, "value") : 1;
}

bool scaleEmitter(const SceneDocument& document, XmlElement& emitter, double factor) {
  const std::string type = typeOf(emitter), color = colorOf(type);
  if (!color.empty()) return scaleColor(document, emitter, color, factor);
  if (!hasScale(type)) return false;
  for (const char* part : {"sunScale", "skyScale"})
    if (findParameter(emitter, part)) setNumber(emitter, part, scaleOf(emitter, part) * factor);
  return setNumber(emitter, "scale", scaleOf(emitter, "scale") * factor);
}

// Adds operations to the element's toWorld, and to each of its keyframes: as its last steps, in world
// space, or as its first, in the object's own.
enum class Where { kFirst, kLast };
void addOperations(XmlElement& element, const std::vector<XmlElement>& operations, Where where) {
  const auto addTo = [&](XmlElement& transform) {
    auto& children = transform.children;
    children.insert(where == Where::kFirst ? children.begin() : children.end(), operations.begin(),
                    operations.end());
  };
  XmlElement* toWorld = findParameter(element, "toWorld");
  if (!toWorld) {
    element.children.push_back(makeElement(element, "transform", {{"name", "toWorld"}}));
    toWorld = &element.children.back();
  }
  if (toWorld->name == "animation")
    for (XmlElement& key : toWorld->children) addTo(key);
  else
    addTo(*toWorld);
}

// Calls look(element) for every element, parents first.
void forEach(const XmlElement& element, const std::function<void(const XmlElement&)>& look) {
  look(element);
  for (const XmlElement& child : element.children) forEach(child, look);
}

// The matrix of its toWorld, of the first keyframe's where it moves.
glm::dmat4 matrixOf(const XmlElement& element) {
  const XmlElement* const toWorld = findParameter(element, "toWorld");
  if (!toWorld) return glm::dmat4(1);
  if (toWorld->name == "animation") return readAnimation(*toWorld)[0].matrix;
  return glm::dmat4(readTransform(*toWorld));
}

glm::dvec3 placeOf(const XmlElement& element) {
  if (const XmlElement* const position = findParameter(element, "position"))
    return readVector(*position);
  const XmlElement* const center = findParameter(element, "center");
  return glm::dvec3(matrixOf(element) *
                    glm::dvec4(center ? readVector(*center) : glm::dvec3(0), 1));
}

double largest(const glm::dvec3& c) { return std::max({c.x, c.y, c.z}); }

// The largest channel of a colour that scaleColor can multiply; infinite for one that it can't.
double largestColor(const SceneDocument& document, const XmlElement& element,
                    const std::string& name) {
  const XmlElement* const given = findParameter(element, name);
  if (!given) return 1;
  if (isReference(*given)) return INFINITY;
  if (!isTexture(*given)) return largest(glm::dvec3(readColor(document, *given)));
  if (typeOf(*given) != "checkerboard" || !findParameter(*given, "color0") ||
      !findParameter(*given, "color1"))
    return INFINITY;
  return std::max(largestColor(document, *given, "color0"),
                  largestColor(document, *given, "color1"));
}

}  // namespace

int setRoughness(SceneDocument& document, double alpha) {
  return edit(document, [&](XmlElement& element) {
    if (element.name != "bsdf" || !isOneOf(typeOf(element), {"roughconductor", "roughdielectric",
                                                             "roughplastic", "roughcoating"}))
      return false;
    removeParameter(element, "alphaU");
    removeParameter(element, "alphaV");
    return setNumber(element, "alpha", alpha);
  });
}

int setPhongExponent(SceneDocument& document, double exponent) {
  return edit(document, [&](XmlElement& element) {
    return element.name == "bsdf" && typeOf(element) == "phong" &&
           setNumber(element, "exponent", exponent);
  });
}

int setRefractiveIndex(SceneDocument& document, double index) {
  return edit(document, [&](XmlElement& element) {
    if (element.name != "bsdf") return false;
    const std::string type = typeOf(element);
    const bool differs =
        isOneOf(type, {"roughdielectric", "roughplastic", "coating", "roughcoating"});
    if (!differs && !isOneOf(type, {"dielectric", "plastic"})) return false;
    if (differs && index == 1) return false;
    // Their other spelling is no snake_case.
    for (XmlElement& child : element.children)
      for (XmlAttribute& attribute : child.attributes) {
        if (attribute.name != "name") continue;
        if (attribute.value == "int_ior") attribute.value = "intIOR";
        if (attribute.value == "ext_ior") attribute.value = "extIOR";
      }
    const bool inside = setNumber(element, "intIOR", index);
    return setNumber(element, "extIOR", 1) || inside;
  });
}

int scaleRadiance(SceneDocument& document, double factor) {
  if (factor == 1) return 0;
  return edit(document, [&](XmlElement& element) {
    return isEmitter(element) && scaleEmitter(document, element, factor);
  });
}

int shrinkLights(SceneDocument& document, double share) {
  if (share == 1) return 0;
  const double length = std::sqrt(share);
  return edit(document, [&](XmlElement& element) {
    const std::string type = typeOf(element);
    if (element.name != "shape" || !isOneOf(type, {"rectangle", "disk", "cube", "sphere"}))
      return false;
    bool changed = false;
    for (XmlElement& child : element.children)
      if (isEmitter(child) && typeOf(child) == "area")
        changed |= scaleColor(document, child, "radiance", 1 / share);
    if (!changed) return false;
    if (type == "sphere") {
      const XmlElement* const radius = findParameter(element, "radius");
      setNumber(element, "radius", (radius ? readNumber(*radius, "value") : 1) * length);
    } else {
      addOperations(element, {makeElement(element, "scale", {{"value", text(length)}})},
                    Where::kFirst);
    }
    return true;
  });
}

namespace {

// What stands inside shape groups, whose place their instances decide on.
std::set<const XmlElement*> inGroups(const SceneDocument& document) {
  std::set<const XmlElement*> inside;
  forEach(document.root, [&](const XmlElement& element) {
    if (element.name == "shape" && typeOf(element) == "shapegroup")
      for (const XmlElement& child : element.children) inside.insert(&child);
  });
  return inside;
}

}  // namespace

int moveScene(SceneDocument& document, double scale, const glm::dvec3& offset) {
  const bool moves = offset != glm::dvec3(0);
  if (scale == 1 && !moves) return 0;
  const auto operationsOf = [&](const XmlElement& element) {
    std::vector<XmlElement> operations;
    if (scale != 1) operations.push_back(makeElement(element, "scale", {{"value", text(scale)}}));
    if (moves) operations.push_back(makeElement(element, "translate", {{"value", text(offset)}}));
    return operations;
  };
  const auto scaleNumber = [&](XmlElement& element, const char* name, double otherwise) {
    const XmlElement* const given = findParameter(element, name);
    if (given || otherwise > 0)
      setNumber(element, name, (given ? readNumber(*given, "value") : otherwise) * scale);
  };
  const auto grouped = inGroups(document);
  return edit(document, [&](XmlElement& element) {
    const std::string type = typeOf(element);
    if (element.name == "shape") {
      if (type == "deforming") return false;  // the shapes inside it move
      if (type == "shapegroup" || grouped.count(&element)) return false;
      addOperations(element, operationsOf(element), Where::kLast);
      return true;
    }
    if (element.name == "sensor" || element.name == "camera") {
      addOperations(element, operationsOf(element), Where::kLast);
      if (scale != 1) {
        constexpr double kNearClip = 1e-2, kFarClip = 1e4;  // the reader's defaults
        scaleNumber(element, "nearClip", kNearClip);
        scaleNumber(element, "farClip", kFarClip);
        scaleNumber(element, "focusDistance", 0);
      }
      return true;
    }
    if (isAtPoint(element)) {
      if (XmlElement* const position = findParameter(element, "position"))
        *position = makeElement(
            *position, "point",
            {{"name", "position"}, {"value", text(readVector(*position) * scale + offset)}});
      else
        addOperations(element, operationsOf(element), Where::kLast);
      if (scale != 1) scaleEmitter(document, element, scale * scale);
      return true;
    }
    return false;
  });
}

ScenePlaces placesOf(const SceneDocument& document) {
  ScenePlaces places;
  const auto grouped = inGroups(document);
  bool hasCamera = false;
  forEach(document.root, [&](const XmlElement& element) {
    const std::string type = typeOf(element);
    if (element.name == "sensor" || element.name == "camera") {
      places.camera = placeOf(element);
      hasCamera = true;
    } else if (element.name == "shape") {
      if (type != "deforming" && type != "shapegroup" && !grouped.count(&element))
        places.things.push_back(placeOf(element));
    } else if (isAtPoint(element)) {
      places.things.push_back(placeOf(element));
    }
  });
  if (!hasCamera) places.things.clear();
  return places;
}

double brightestLight(const SceneDocument& document) {
  double radiance = 0, intensity = 0;
  forEach(document.root, [&](const XmlElement& element) {
    if (!isEmitter(element)) return;
    const std::string type = typeOf(element), color = colorOf(type);
    if (!color.empty()) {
      double& brightest = isOneOf(color, {"intensity", "power"}) ? intensity : radiance;
      brightest = std::max(brightest, largestColor(document, element, color));
    } else if (type == "projector") {
      intensity = std::max(intensity, scaleOf(element, "scale"));
    } else if (hasScale(type)) {
      int given = 0;
      for (const char* part : {"sunScale", "skyScale"}) {
        if (!findParameter(element, part)) continue;
        ++given;
        radiance = std::max(radiance, scaleOf(element, part));
      }
      // What "scale" stands for where they don't say.
      if (given < 2) radiance = std::max(radiance, scaleOf(element, "scale"));
    }
  });
  const double brightest = radiance > 0 ? radiance : intensity;
  return std::isfinite(brightest) ? brightest : 0;
}

}  // namespace h2mc
