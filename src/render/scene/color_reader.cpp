// SPDX-License-Identifier: MIT
#include "render/scene/color_reader.h"

#include <algorithm>
#include <string>

#include "ad/traits.h"
#include "render/scene/spectrum.h"
#include "render/scene/suggestion.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// "wavelength:value wavelength:value ..." of a file with lines "wavelength value", where # starts a comment.
std::string pairsOfFile(const std::string& content) {
  std::string text;
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string line = content.substr(at, std::min(end, content.find('#', at)) - at);
    at = end + 1;
    const auto parts = splitList(line);
    if (parts.empty()) continue;
    if (parts.size() != 2)
      throw ValueError("a line of the spectrum's file is not \"wavelength value\"");
    text += std::string(parts[0]) + ":" + std::string(parts[1]) + " ";
  }
  if (text.empty()) throw ValueError("the spectrum's file is empty");
  return text;
}

}  // namespace

bool isColorElement(std::string_view name) {
  return isOneOf(name, {"rgb", "srgb", "spectrum", "blackbody", "float", "integer"});
}

bool isPlainSpectrum(const XmlElement& element) {
  return element.name == "spectrum" &&
         isOneOf(lowerCase(element.attribute("type")), {"uniform", "d65", "srgb"});
}

// Before it is known to be within float.
static Rgbf anyColor(const SceneDocument& document, const XmlElement& element, bool mayBeNegative,
                     Rgbf* saturated) {
  if (isPlainSpectrum(element)) {
    // White (d65 is the white of RGB) times the numbers and colours inside.
    element.allowAttributes({"name", "type", "id"});
    Rgbf product(1);
    for (const XmlElement& child : element.children) {
      const std::string name = child.attribute("name");
      if (!isOneOf(name, {"value", "scale", "color"}) || !isColorElement(child.name))
        throw sourceError(child.place("name"),
                          "<" + child.name + " name=\"" + name + "\"> inside <spectrum>",
                          "expected <float name=\"value\"/>, <float name=\"scale\"/> or "
                          "<rgb name=\"color\"/>");
      product *= readColor(document, child, mayBeNegative, saturated);
    }
    return product;
  }
  std::string_view attribute = "value";
  try {
    if (element.name == "blackbody") {
      element.allowAttributes({"name", "temperature", "scale", "multiplier"});
      attribute = "temperature";
      std::string_view text = trimmed(element.require("temperature"));
      if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.remove_suffix(1);
      const double temperature = parseNumber(text);
      if (!(temperature > 0)) throw ValueError("a temperature is positive");
      double scale = 1;
      for (std::string_view name : {"scale", "multiplier"}) {
        if (!element.find(name)) continue;
        attribute = name;
        scale *= parseNumber(element.attribute(name));
      }
      if (scale < 0) throw ValueError("a scale must not be negative");
      return intoGamut(blackbodyToRgb(temperature) * static_cast<float>(scale), saturated);
    }
    if (element.name == "spectrum" && element.find("filename")) {
      element.allowAttributes({"name", "filename"});
      attribute = "filename";
      const std::string file = resolveFile(document, element, "filename");
      std::string content;
      try {
        content = readTextFile(file);
      } catch (const std::runtime_error& e) {
        throw sourceError(element.place("filename"), "cannot read \"" + file + "\": " + e.what());
      }
      return parseSpectrum(pairsOfFile(content), mayBeNegative, saturated);
    }
    element.allowAttributes({"name", "value", "intent"});
    const std::string& text = element.require("value");
    if (element.name == "spectrum") return parseSpectrum(text, mayBeNegative, saturated);
    if (element.name == "rgb" || element.name == "srgb")
      return parseRgb(text, element.name == "srgb", mayBeNegative);
    const double grey = parseNumber(text);
    if (grey < 0 && !mayBeNegative) throw ValueError("a colour must not be negative");
    return Rgbf(static_cast<float>(grey));
  } catch (const ValueError& e) {
    throw sourceError(element.place(attribute), e.what(),
                      "expected a colour: value=\"r, g, b\", value=\"grey\", value=\"#rrggbb\" or, "
                      "in a <spectrum>, value=\"wavelength:value, ...\"");
  }
}

Rgbf readColor(const SceneDocument& document, const XmlElement& element, bool mayBeNegative,
               Rgbf* saturated) {
  const Rgbf color = anyColor(document, element, mayBeNegative, saturated);
  if (!ad::isFinite(color))
    throw sourceError(element.place(), "the colour is too large",
                      "expected products, and sums over a spectrum, up to 3.4e38");
  return color;
}

}  // namespace h2mc
