// SPDX-License-Identifier: MIT
#include "render/scene/old_spellings.h"

#include <algorithm>

#include "render/scene/scene_document.h"
#include "render/scene/suggestion.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

struct Renamed {
  std::string_view element, type, name;  // "": any
  std::string_view today;
  int below = 99;  // the minor version from which on the old name means something else, or nothing
};

// Plugins.
constexpr Renamed kTypes[] = {
    {"integrator", "errctrl", "", "adaptive"},    {"film", "exrfilm", "", "hdrfilm"},
    {"film", "pngfilm", "", "ldrfilm"},           {"bsdf", "mirror", "", "conductor"},
    {"bsdf", "roughmetal", "", "roughconductor"}, {"bsdf", "roughglass", "", "roughdielectric"},
    {"bsdf", "composite", "", "mixturebsdf"},     {"bsdf", "bump", "", "bumpmap"},
    {"bsdf", "microfacet", "", "roughplastic"},   {"texture", "exrtexture", "", "bitmap"},
    {"texture", "ldrtexture", "", "bitmap"},
};

// Parameters, by their plugin's old name.
constexpr Renamed kParameters[] = {
    {"luminaire", "area", "intensity", "radiance"},
    {"luminaire", "constant", "intensity", "radiance"},
    {"luminaire", "directional", "intensity", "irradiance"},
    {"luminaire", "envmap", "intensityScale", "scale"},
    {"emitter", "envmap", "intensityScale", "scale"},
    {"integrator", "", "luminaireSamples", "emitterSamples"},
    {"camera", "", "focusDepth", "focusDistance"},
    {"shape", "sphere", "inverted", "flipNormals"},
    {"shape", "cylinder", "p1", "p0", 3},
    {"shape", "cylinder", "p2", "p1", 3},
    {"texture", "checkerboard", "brightColor", "color0"},
    {"texture", "checkerboard", "darkColor", "color1"},
    {"texture", "gridtexture", "brightColor", "color0"},
    {"texture", "gridtexture", "darkColor", "color1"},
    {"bsdf", "ward", "alphaX", "alphaU"},
    {"bsdf", "ward", "alphaY", "alphaV"},
    {"bsdf", "microfacet", "alphaB", "alpha"},
    {"bsdf", "roughmetal", "alphaB", "alpha"},
    {"bsdf", "roughmetal", "ior", "eta"},
    {"bsdf", "roughglass", "alphaB", "alpha"},
};

// The minor version of 0.x; 6 for what is not told.
int minorVersion(const XmlElement& scene) {
  const std::string version = scene.attribute("version");
  const bool known =
      version.size() > 2 && version.rfind("0.", 0) == 0 && version[2] >= '0' && version[2] <= '9';
  return known ? version[2] - '0' : 6;
}

XmlElement* findNamed(XmlElement& element, std::string_view name) {
  for (XmlElement& child : element.children)
    if (child.attribute("name") == name) return &child;
  return nullptr;
}

void setAttribute(XmlElement& element, std::string_view name, std::string_view value) {
  for (XmlAttribute& attribute : element.attributes)
    if (attribute.name == name) attribute.value = value;
}

void rename(XmlElement& element, int version) {
  const std::string type = lowerCase(element.attribute("type"));
  for (XmlElement& child : element.children) {
    const std::string name = child.attribute("name");
    for (const Renamed& r : kParameters) {
      if (r.element != element.name || (!r.type.empty() && r.type != type) || r.name != name ||
          version >= r.below)
        continue;
      setAttribute(child, "name", r.today);
      break;  // what was p1 is p0 now, and what was p2 is p1
    }
  }
  for (const Renamed& r : kTypes)
    if (r.element == element.name && r.type == type) setAttribute(element, "type", r.today);
  if (element.name == "bsdf" && type == "mirror")
    element.children.push_back(
        makeElement(element, "string", {{"name", "material"}, {"value", "Cr"}}));
  if (element.name == "film")
    std::erase_if(element.children, [](const XmlElement& child) {
      return child.name == "boolean" && child.attribute("name") == "alpha";
    });
}

// <lookAt ox="" oy="" oz="" tx="" ..>, which looked in a mirror.
void modernLookAt(XmlElement& transform) {
  for (std::size_t i = 0; i < transform.children.size(); ++i) {
    XmlElement& child = transform.children[i];
    if (lowerCase(child.name) != "lookat" || !child.find("ox")) continue;
    const auto triple = [&](const char* x, const char* y, const char* z) {
      return child.attribute(x) + ", " + child.attribute(y) + ", " + child.attribute(z);
    };
    XmlElement today =
        makeElement(child, "lookat",
                    {{"origin", triple("ox", "oy", "oz")}, {"target", triple("tx", "ty", "tz")}});
    if (child.find("ux")) {
      const XmlElement up = makeElement(child, "lookat", {{"up", triple("ux", "uy", "uz")}});
      today.attributes.push_back(up.attributes[0]);
    }
    const XmlElement mirror = makeElement(child, "scale", {{"x", "-1"}});
    child = std::move(today);
    transform.children.insert(transform.children.begin() + static_cast<std::ptrdiff_t>(i), mirror);
    ++i;
  }
}

// Before 0.4 cameras had the other hand, and fov was along the smaller side.
void modernCamera(XmlElement& camera) {
  if (camera.attribute("type") == "perspective") {
    const XmlElement* const side = findNamed(camera, "mapSmallerSide");
    const bool larger = side && trimmed(side->attribute("value")) == "false";
    std::erase_if(camera.children, [](const XmlElement& child) {
      return child.attribute("name") == "mapSmallerSide";
    });
    if (!findNamed(camera, "fovAxis"))
      camera.children.push_back(makeElement(
          camera, "string", {{"name", "fovAxis"}, {"value", larger ? "larger" : "smaller"}}));
  }
  if (!findNamed(camera, "toWorld"))
    camera.children.push_back(makeElement(camera, "transform", {{"name", "toWorld"}}));
  XmlElement& toWorld = *findNamed(camera, "toWorld");
  toWorld.children.insert(toWorld.children.begin(), makeElement(toWorld, "scale", {{"x", "-1"}}));
}

// diffuseAmount and specularAmount were factors beside the reflectances, whose defaults differed.
void modernAmounts(XmlElement& bsdf) {
  const bool microfacet = bsdf.attribute("type") == "microfacet";
  for (const bool diffuse : {true, false}) {
    const std::string amountName = diffuse ? "diffuseAmount" : "specularAmount";
    const std::string name = diffuse ? "diffuseReflectance" : "specularReflectance";
    double amount = 1;
    if (const XmlElement* const given = findNamed(bsdf, amountName)) {
      try {
        amount = parseNumber(given->attribute("value"));
      } catch (const ValueError& e) {
        throw sourceError(given->place("value"), e.what());
      }
    }
    std::erase_if(bsdf.children,
                  [&](const XmlElement& child) { return child.attribute("name") == amountName; });
    XmlElement* const reflectance = findNamed(bsdf, name);
    if (!reflectance) {
      const double fallback = microfacet ? (diffuse ? 0 : 1) : (diffuse ? 0.5 : 0.2);
      bsdf.children.push_back(makeElement(
          bsdf, "spectrum", {{"name", name}, {"value", std::to_string(fallback * amount)}}));
    } else if (amount != 1) {
      const bool plain = reflectance->name == "rgb" || reflectance->name == "spectrum";
      if (!plain || !reflectance->find("value"))
        throw sourceError(
            reflectance->place(),
            "\"" + amountName + "\" can't be multiplied with this <" + reflectance->name + ">",
            "expected <rgb> or <spectrum>, or an amount of 1");
      Rgbf c;
      try {
        c = parseSpectrum(reflectance->attribute("value"));
      } catch (const ValueError& e) {
        throw sourceError(reflectance->place("value"), e.what());
      }
      const auto scaled = [&](float x) { return std::to_string(static_cast<double>(x) * amount); };
      reflectance->name = "rgb";
      setAttribute(*reflectance, "value", scaled(c.x) + ", " + scaled(c.y) + ", " + scaled(c.z));
    }
  }
}

void modernise(XmlElement& element, int version) {
  if (version < 3) {
    const std::string type = element.attribute("type");
    modernLookAt(element);
    if (element.name == "bsdf" && (type == "microfacet" || type == "phong" || type == "ward"))
      modernAmounts(element);
  }
  rename(element, version);
  if (version < 4 && element.name == "camera") modernCamera(element);
  for (XmlElement& child : element.children) modernise(child, version);
}

}  // namespace

void modernise(XmlElement& scene) {
  if (isOldVersion(scene)) modernise(scene, minorVersion(scene));
}

}  // namespace h2mc
