// SPDX-License-Identifier: MIT
#include "render/scene/element_properties.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "render/core/index.h"
#include "render/scene/change_note.h"
#include "render/scene/color_reader.h"
#include "render/scene/transform_reader.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// Which elements may give a parameter.
bool accepts(const Parameter& parameter, std::string_view element) {
  switch (parameter.type) {
    case ParameterType::kBoolean:
      return element == "boolean";
    case ParameterType::kInteger:
      return isOneOf(element, {"integer", "long"});
    case ParameterType::kNumber:
      return isOneOf(element, {"float", "integer"});
    case ParameterType::kString:
      // A word that stands for a number, as in intIOR: the number itself will do.
      return element == "string" || (parameter.choices.empty() && !parameter.fallback.empty() &&
                                     isOneOf(element, {"float", "integer"}));
    case ParameterType::kColor:
      return isColorElement(element);
    case ParameterType::kTexture:
      return isColorElement(element) || element == "texture";
    case ParameterType::kPoint:
    case ParameterType::kVector:
      return isOneOf(element, {"point", "vector"});
    case ParameterType::kTransform:
      return isOneOf(element, {"transform", "animation"});
  }
  return false;
}

// How one writes a parameter, and what it is called.
std::pair<std::string, std::string> spelling(const Parameter& p) {
  const std::string name = " name=\"" + std::string(p.name) + "\"";
  switch (p.type) {
    case ParameterType::kBoolean:
      return {"a boolean", "<boolean" + name + " value=\"true\"/>"};
    case ParameterType::kInteger:
      return {"an integer", "<integer" + name + " value=\"...\"/>"};
    case ParameterType::kNumber:
      return {"a number", "<float" + name + " value=\"...\"/>"};
    case ParameterType::kString:
      return {"a string", "<string" + name + " value=\"...\"/>"};
    case ParameterType::kColor:
      return {"a colour", "<rgb" + name + " value=\"r, g, b\"/>"};
    case ParameterType::kTexture:
      return {"a colour or texture",
              "<rgb" + name + " value=\"r, g, b\"/> or <texture" + name + " type=\"...\">"};
    case ParameterType::kPoint:
      return {"a point", "<point" + name + " x=\"\" y=\"\" z=\"\"/>"};
    case ParameterType::kVector:
      return {"a vector", "<vector" + name + " x=\"\" y=\"\" z=\"\"/>"};
    case ParameterType::kTransform:
      return {"a transform", "<transform" + name + ">"};
  }
  return {};
}

Names splitChoices(std::string_view choices) {
  Names names;
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    names.emplace_back(choices.substr(0, bar));
    choices = bar == std::string_view::npos ? "" : choices.substr(bar + 1);
  }
  return names;
}

bool matches(const Parameter& parameter, std::string_view written) {
  return written == parameter.name || written == snakeCase(parameter.name) ||
         (!parameter.otherName.empty() &&
          (written == parameter.otherName || written == snakeCase(parameter.otherName)));
}

std::string checkedChoice(const Parameter& parameter, const std::string& value) {
  if (parameter.choices.empty()) return value;
  std::string word = lowerCase(trimmed(value));
  const Names choices = splitChoices(parameter.choices);
  for (const std::string& choice : choices)
    if (lowerCase(choice) == word) return word;
  throw ValueError("\"" + value + "\" is not a value of \"" + std::string(parameter.name) +
                   "\"\nexpected one of the choices; " + suggestion(value, choices));
}

int checkedInteger(std::string_view text) {
  const long long value = parseInteger(text);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    throw ValueError("\"" + std::string(text) + "\" is too large an integer");
  return static_cast<int>(value);
}

}  // namespace

bool isParameterElement(const XmlElement& element) {
  return isOneOf(element.name,
                 {"boolean", "integer", "long", "float", "string", "rgb", "srgb", "spectrum",
                  "blackbody", "point", "vector", "transform", "animation"});
}

bool isTexture(const XmlElement& element) {
  return element.name == "texture" ||
         (element.name == "spectrum" && element.find("type") && !isPlainSpectrum(element));
}

bool isEmitter(const XmlElement& element) {
  return element.name == "emitter" || element.name == "luminaire";
}

bool isReference(const XmlElement& element) {
  return element.name == "ref" || element.name == "reference";
}

ElementProperties::ElementProperties(ReaderContext& context, const XmlElement& element,
                                     ElementTable table)
    : context_(context), element_(element), table_(std::move(table)) {
  type_ = lowerCase(element.attribute("type"));
  // Every child is looked at, so that all mistakes are known; what is made of them is then made of none.
  std::optional<SceneError> first;
  const auto attempt = [&](const auto& read) {
    try {
      read();
    } catch (const SceneError& e) {
      context_.problems.add(e);
      if (!first) first = e;
    }
  };
  attempt([&] { allowAttributes(element, {"type", "id", "name"}); });
  for (const XmlElement& child : element.children) attempt([&] { readChild(child); });
  if (nestedBsdfCount() > table_.nestedBsdfs)
    attempt([&] {
      throw sourceError(nested_[at(table_.nestedBsdfs)]->place(),
                        description() + " takes at most " + std::to_string(table_.nestedBsdfs) +
                            " bsdf" + (table_.nestedBsdfs == 1 ? "" : "s"));
    });
  if (first) throw SceneError(*first);
}

void ElementProperties::allowAttributes(const XmlElement& element,
                                        std::initializer_list<std::string_view> names) const {
  for (const XmlAttribute& a : element.attributes)
    if (!isOneOf(a.name, names))
      context_.problems.tolerate({element.file, a.nameOffset},
                                 "unknown attribute \"" + a.name + "\" of <" + element.name + ">",
                                 suggestion(a.name, Names(names.begin(), names.end())));
}

void ElementProperties::readChild(const XmlElement& child) {
  const auto isObject = [&](const std::string& name) {
    return std::find(table_.objects.begin(), table_.objects.end(), name) != table_.objects.end();
  };
  if (isReference(child)) {
    allowAttributes(child, {"name", "id"});
    const XmlElement& target = context_.resolve(child);
    if (isTexture(target)) {
      readParameter(child);
    } else if (target.name == "bsdf" && table_.nestedBsdfs > 0) {
      nested_.push_back(&child);
    } else if (!isObject(target.name)) {
      throw sourceError(child.place("id"),
                        "a reference to a " + target.name + " inside " + description());
    }
  } else if (isParameterElement(child) || child.name == "texture") {
    readParameter(child);
  } else if (child.name == "bsdf" && table_.nestedBsdfs > 0) {
    nested_.push_back(&child);
  } else if (!isObject(child.name)) {
    Names names = {"boolean", "float",  "integer",   "string",  "rgb", "spectrum",
                   "point",   "vector", "transform", "texture", "ref"};
    if (table_.nestedBsdfs > 0) names.push_back("bsdf");
    names.insert(names.end(), table_.objects.begin(), table_.objects.end());
    throw sourceError(child.place(), "<" + child.name + "> inside " + description(),
                      "expected an element that belongs here; " + suggestion(child.name, names));
  }
}

std::string ElementProperties::description() const {
  return type_.empty() ? table_.kind : table_.kind + " \"" + type_ + "\"";
}

Names ElementProperties::parameterNames() const {
  // In the file's own spelling: snake_case where its version says so.
  const XmlElement& root = context_.document.root;
  const bool snake = root.find("version") && !h2mc::isOldVersion(root);
  Names names;
  for (const Parameter& p : table_.parameters)
    names.push_back(snake ? snakeCase(p.name) : std::string(p.name));
  return names;
}

const Parameter* ElementProperties::match(std::string_view written) const {
  for (const Parameter& p : table_.parameters)
    if (matches(p, written)) return &p;
  return nullptr;
}

const Parameter* ElementProperties::unnamedTexture(const XmlElement& child) const {
  if (!isTexture(context_.resolve(child))) return nullptr;
  for (const Parameter& p : table_.parameters)
    if (p.unnamed) return &p;
  return nullptr;
}

void ElementProperties::readParameter(const XmlElement& child) {
  const Parameter* const unnamed = unnamedTexture(child);
  if (!child.find("name") && !unnamed)
    throw sourceError(child.place(),
                      "<" + child.name + "> inside " + description() + " has no name",
                      "expected name=\"...\"; available: " + joined(parameterNames()));
  const std::string written = child.attribute("name");
  const Parameter* parameter = match(written);
  if (!parameter) parameter = unnamed;
  if (!parameter) {
    if (table_.acceptUnknown) {
      context_.note("accepted and not used: parameter \"" + written + "\" of " + description());
      return;
    }
    const std::string message = "unknown parameter \"" + written + "\" of " + description();
    const std::string hint =
        "expected a parameter that it has; " + suggestion(written, parameterNames());
    // A texture is no leftover: it was meant to be seen.
    if (isTexture(context_.resolve(child)))
      context_.problems.refuse(child.place("name"), message, "the texture is not used\n" + hint);
    else
      context_.problems.tolerate(child.place("name"), message, hint);
    return;
  }
  const auto earlier = std::find_if(given_.begin(), given_.end(),
                                    [&](const auto& entry) { return entry.first == parameter; });
  if (earlier != given_.end()) {
    context_.problems.tolerate(
        child.place("name"),
        "parameter \"" + written + "\" of " + description() + " is given twice",
        "first at " + describe(earlier->second->place("name")) + "; the last one counts");
    given_.erase(earlier);
  }
  if (parameter->ignored && parameter->name == "maxSmoothAngle") {
    context_.problems.warn(child.place("name"),
                           "\"maxSmoothAngle\" of " + description() + " is not used",
                           "the normals are those that the mesh has without it");
  } else if (parameter->ignored) {
    context_.note("accepted and not used: parameter \"" + std::string(parameter->name) + "\" of " +
                  description());
  } else {
    checkValue(*parameter, child);
  }
  given_.emplace_back(parameter, &child);
}

void ElementProperties::checkValue(const Parameter& parameter, const XmlElement& child) const {
  const XmlElement& target = context_.resolve(child);
  const auto [what, example] = spelling(parameter);
  if (!accepts(parameter, isTexture(target) ? "texture" : target.name))
    throw sourceError(child.place(),
                      "parameter \"" + std::string(parameter.name) + "\" of " + description() +
                          " is " + what + ", not a <" + target.name + ">",
                      "expected " + example);
  if (isTexture(target)) return;
  if (!child.children.empty() && !isPlainSpectrum(child) &&
      parameter.type != ParameterType::kTransform)
    throw sourceError(child.children[0].place(),
                      "<" + child.children[0].name + "> inside <" + child.name + ">");
  try {
    switch (parameter.type) {
      case ParameterType::kBoolean:
      case ParameterType::kInteger:
      case ParameterType::kNumber:
      case ParameterType::kString: {
        allowAttributes(child, {"name", "value"});
        const std::string& value = child.require("value");
        if (parameter.type == ParameterType::kBoolean) parseBoolean(value);
        if (parameter.type == ParameterType::kInteger) checkedInteger(value);
        if (parameter.type == ParameterType::kNumber || child.name == "float") {
          const bool zero = static_cast<float>(parseNumber(value)) == 0;
          if (zero && value.find_first_of("123456789") < value.find_first_of("eE"))
            context_.note(changeNote(child.place("value"),
                                     "\"" + std::string(parameter.name) + "\" of " + description(),
                                     value, "0, the nearest float"));
        }
        if (parameter.type == ParameterType::kString) checkedChoice(parameter, value);
        break;
      }
      case ParameterType::kColor:
      case ParameterType::kTexture: {
        Rgbf saturated(0);
        const Rgbf color = readColor(context_.document, child, parameter.mayBeNegative, &saturated);
        if (saturated != Rgbf(0))
          context_.note(changeNote(
              child.place(), "\"" + std::string(parameter.name) + "\" of " + description(),
              "a spectrum beyond Rec. 709, " + colorText(saturated), colorText(color)));
        if (color.x < 0 || color.y < 0 || color.z < 0)
          context_.problems.warn(child.place("value"),
                                 "\"" + std::string(parameter.name) + "\" of " + description() +
                                     " has a negative channel",
                                 "only its absolute value counts");
        break;
      }
      case ParameterType::kPoint:
      case ParameterType::kVector:
        child.allowAttributes({"name", "x", "y", "z", "value"});
        if (!child.find("value"))
          for (std::string_view axis : {"x", "y", "z"})
            if (!child.find(axis) && !(child.find("x") || child.find("y") || child.find("z")))
              child.require(axis);
        readVector(child);
        break;
      case ParameterType::kTransform:
        if (child.name == "animation") {
          readAnimation(child);
        } else {
          readTransform(child);
        }
        break;
    }
  } catch (const ValueError& e) {
    const std::string message = e.what();
    const std::size_t line = message.find('\n');
    throw sourceError(child.place("value"), message.substr(0, line),
                      line == std::string::npos ? "expected " + example : message.substr(line + 1));
  }
}

const Parameter& ElementProperties::find(std::string_view name) const {
  for (const Parameter& p : table_.parameters)
    if (p.name == name) return p;
  throw std::logic_error("the table of " + description() + " has no parameter \"" +
                         std::string(name) + "\"");
}

const XmlElement* ElementProperties::source(std::string_view name) const {
  const Parameter* parameter = &find(name);
  for (const auto& [p, element] : given_)
    if (p == parameter) return element;
  return nullptr;
}

bool ElementProperties::given(std::string_view name) const { return source(name) != nullptr; }

// Values in the file were checked when they were read; what fails here is the default.
template <class Parse>
auto ElementProperties::parse(std::string_view name, Parse parse) const {
  const XmlElement* child = source(name);
  if (!child && find(name).fallback.empty())
    fail(name, description() + " has no \"" + std::string(name) + "\"",
         "expected " + spelling(find(name)).second);
  try {
    return parse(child ? child->attribute("value") : std::string(find(name).fallback));
  } catch (const ValueError& e) {
    fail(name, e.what());
    throw;  // not reached
  }
}

bool ElementProperties::boolean(std::string_view name) const { return parse(name, parseBoolean); }
int ElementProperties::integer(std::string_view name) const { return parse(name, checkedInteger); }
float ElementProperties::number(std::string_view name) const {
  return static_cast<float>(parse(name, parseNumber));
}

std::string ElementProperties::string(std::string_view name) const {
  const Parameter& parameter = find(name);
  if (!given(name) && parameter.choices.empty()) return std::string(parameter.fallback);
  return parse(name, [&](const std::string& text) { return checkedChoice(parameter, text); });
}

Rgbf ElementProperties::color(std::string_view name) const {
  if (const XmlElement* child = source(name)) {
    if (isTexture(context_.resolve(*child))) fail(name, "expected a colour, not a texture");
    return readColor(context_.document, *child, find(name).mayBeNegative);
  }
  return parse(name, [](const std::string& text) { return parseSpectrum(text); });
}

TexturePtr ElementProperties::texture(std::string_view name) const {
  const XmlElement* child = source(name);
  if (child && isTexture(context_.resolve(*child)))
    return context_.texture(*child, table_.texelsMayBeNegative || find(name).mayBeNegative);
  return constantTexture(color(name));
}

Vec3f ElementProperties::vector(std::string_view name) const {
  if (const XmlElement* child = source(name)) return Vec3f(readVector(*child));
  return parse(name, [](const std::string& text) {
    const std::vector<double> v = parseNumbers(text);
    if (v.size() != 3) throw ValueError("expected 3 numbers");
    return Vec3f(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  });
}

Mat4 ElementProperties::transform(std::string_view name) const {
  const Motion found = motion(name);
  if (found.moves())
    fail(name, description() + " can't move",
         "expected keyframes that are all the same, or a <transform>");
  return Mat4(found.at(0));
}

Motion ElementProperties::motion(std::string_view name) const {
  const XmlElement* child = source(name);
  if (!child) return Motion();
  if (child->name != "animation") return Motion(glm::dmat4(readTransform(*child)));
  const std::vector<Motion::Keyframe> frames = readAnimation(*child);
  const double open = context_.scene.camera.shutterOpen, close = context_.scene.camera.shutterClose;
  Motion seen(frames, open, close);
  if (!seen.moves() && Motion(frames, frames.front().time, frames.back().time).moves())
    context_.note("an <animation> is not seen to move: the shutter is open from " +
                  std::to_string(open) + " to " + std::to_string(close));
  return seen;
}

bool ElementProperties::isOldVersion() const { return h2mc::isOldVersion(context_.document.root); }

std::string ElementProperties::file(std::string_view name) const {
  const XmlElement* child = source(name);
  if (!child)
    fail(name, description() + " has no \"" + std::string(name) + "\"",
         "expected " + spelling(find(name)).second);
  return resolveFile(context_.document, *child, "value");
}

int ElementProperties::nestedBsdf(int index) const {
  return context_.material(*nested_.at(static_cast<std::size_t>(index)));
}

const Material& ElementProperties::material(int index) const {
  return context_.scene.materials.at(static_cast<std::size_t>(index));
}

SourcePlace ElementProperties::placeOf(std::string_view name) const {
  const XmlElement* const given = source(name);
  return given ? given->place("value") : element_.place();
}

void ElementProperties::warn(std::string_view name, const std::string& message) const {
  context_.problems.warn(placeOf(name), description() + ": " + message);
}

void ElementProperties::changed(std::string_view name, const std::string& given,
                                const std::string& used) const {
  context_.note(
      changeNote(placeOf(name), "\"" + std::string(name) + "\" of " + description(), given, used));
}

void ElementProperties::tolerate(std::string_view name, const std::string& message,
                                 const std::string& hint) const {
  context_.problems.tolerate(placeOf(name), description() + ": " + message, hint);
}

void ElementProperties::refuse(std::string_view name, const std::string& message,
                               const std::string& instead) const {
  context_.problems.refuse(placeOf(name), description() + ": " + message, instead);
}

void ElementProperties::fail(std::string_view name, const std::string& message) const {
  fail(name, description() + ": " + message, "");
}

void ElementProperties::fail(std::string_view name, const std::string& message,
                             const std::string& hint) const {
  const Parameter* parameter = match(name);
  for (const auto& [p, child] : given_)
    if (p == parameter) throw sourceError(child->place("value"), message, hint);
  throw sourceError(element_.place(), message, hint);
}

}  // namespace h2mc
