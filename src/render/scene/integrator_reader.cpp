// SPDX-License-Identifier: MIT
// The <integrator> of a scene and dpt's <dpt>, in terms of our integrators' options.
#include <algorithm>
#include <charconv>

#include "render/core/types.h"
#include "render/scene/change_note.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// Integrators of other renderers and what stands for them here. One that ours has by the same name is
// taken by that name, before this table is looked at.
struct Foreign {
  std::string_view name;
  std::string_view ours;     // "": no method of ours is near it, the choice is left open
  std::string_view warning;  // "": the picture is the same
};
constexpr std::string_view kNoMedia = "participating media are not rendered";
constexpr std::string_view kNearest = "the nearest method that there is";
constexpr Foreign kForeign[] = {
    {"direct", "path", ""},  // with kDirectDepth
    {"volpath", "path", kNoMedia},
    {"volpath_simple", "path", kNoMedia},
    {"volpathmis", "path", kNoMedia},
    {"direct_projective", "path", ""},  // with kDirectDepth
    {"prb", "path", ""},
    {"prb_basic", "path", ""},
    {"prb_projective", "path", ""},
    {"prbvolpath", "path", kNoMedia},
    {"guided_path", "path", kNearest},
    {"guidedpath", "path", kNearest},
    {"ptracer", "bdpt", kNearest},
    {"photonmapper", "photon", kNearest},
    {"ppm", "photon", kNearest},
    {"sppm", "photon", ""},
    {"vcm", "bdpt", kNearest},
    {"upm", "bdpt", kNearest},
    {"vpl", "bdpt", kNearest},
    {"mlt", "mmlt", kNearest},
    {"ao", "", ""},
    {"field", "", ""},
    {"depth", "", ""},
};

// Integrators that do something with the one inside: it stands for them.
constexpr std::string_view kWrappers[] = {"moment",   "adaptive",     "errctrl", "aov",
                                          "irrcache", "multichannel", "stokes"};

// Parameters of other renderers' integrators that mean what an option of ours means.
constexpr std::string_view kShared[] = {"maxDepth", "rrDepth"};

// Paths of direct light: seen directly, and by way of one surface.
constexpr const char* kDirectDepth = "2";

// Parameters of Mitsuba's path and bdpt that ours have no option for, and of its erpt.
constexpr std::string_view kIgnored[] = {"strictNormals",  "lightImage", "sampleDirect",
                                         "samplesPerPass", "blockSize",  "timeout"};
constexpr std::string_view kIgnoredOfErpt[] = {
    "rrDepth",
    "maxChains",
    "lensPerturbation",
    "multiChainPerturbation",
    "causticPerturbation",
    "manifoldPerturbation",
    "lambda",
};

const IntegratorPlugin* find(std::span<const IntegratorPlugin> integrators, std::string_view name) {
  for (const IntegratorPlugin& plugin : integrators)
    if (plugin.name == name) return &plugin;
  return nullptr;
}

// The longest paths that there are, where the scene asks for longer ones.
void noteLongest(ReaderContext& context, const std::string& value, const SourcePlace& place) {
  try {
    const long long wanted = parseInteger(value);
    if (wanted == -1 || wanted > kMaxPathLength)
      context.note(changeNote(place, "\"maxDepth\" of the integrator",
                              wanted == -1 ? "-1, no limit" : value,
                              std::to_string(kMaxPathLength)));
  } catch (const ValueError&) {
    // Said where the option is set.
  }
}

// Sets an option for the chosen integrator, if it has it, and for any other.
void setOption(ReaderContext& context, std::string_view name, const std::string& value,
               const SourcePlace& place) {
  context.scene.options[std::string(name)] = value;
  if (name == "maxDepth") noteLongest(context, value, place);
  if (!context.scene.integrator.has(name)) return;
  try {
    context.scene.integrator.set(name, value);
  } catch (const OptionError& e) {
    throw sourceError(place, e.what());
  }
}

void checkValue(const XmlElement& child) {
  try {
    const std::string& value = child.require("value");
    if (child.name == "boolean") parseBoolean(value);
    if (child.name == "integer") parseInteger(value);
    if (child.name == "float") parseNumber(value);
  } catch (const ValueError& e) {
    throw sourceError(child.place("value"), e.what());
  }
}

bool matches(std::string_view written, std::string_view name) {
  return written == name || written == snakeCase(name);
}

// The kind of element that gives an option, to tell a wrong type.
bool fits(ParameterType type, const std::string& element) {
  switch (type) {
    case ParameterType::kBoolean:
      return element == "boolean";
    case ParameterType::kInteger:
      return element == "integer";
    case ParameterType::kNumber:
      return element == "float" || element == "integer";
    default:
      return element == "string";
  }
}

// The parameter is one of those, in either spelling, or there is none.
template <class Names>
std::string_view among(const Names& names, std::string_view written) {
  for (const std::string_view name : names)
    if (matches(written, name)) return name;
  return "";
}

// Lamps are not seen by the camera itself: paths of one edge are left out.
void hideEmitters(ReaderContext& context, const XmlElement& child) {
  checkValue(child);
  if (!parseBoolean(child.attribute("value"))) return;
  context.hidesEmitters = child.place("value");
  const auto given = context.scene.options.find("minDepth");
  if (given != context.scene.options.end() && parseInteger(given->second) >= 2) return;
  context.note(changeNote(child.place("value"), "\"minDepth\" of the integrator",
                          given != context.scene.options.end() ? given->second : "1",
                          "2, by hideEmitters"));
  setOption(context, "minDepth", "2", child.place("value"));
}

void readOwnParameter(ReaderContext& context, const IntegratorPlugin& plugin,
                      const XmlElement& child, std::span<const std::string_view> ignored) {
  const std::string& written = child.require("name");
  if (matches(written, "hideEmitters")) return;  // by readHidden(), when minDepth is known
  for (const Parameter& p : plugin.parameters) {
    if (!matches(written, p.name)) continue;
    if (!fits(p.type, child.name))
      throw sourceError(child.place(),
                        "parameter \"" + written + "\" of integrator \"" +
                            std::string(plugin.name) + "\" is not a <" + child.name + ">",
                        "expected " +
                            std::string(p.type == ParameterType::kBoolean   ? "<boolean"
                                        : p.type == ParameterType::kInteger ? "<integer"
                                        : p.type == ParameterType::kNumber  ? "<float"
                                                                            : "<string") +
                            " name=\"" + std::string(p.name) + "\" value=\"...\"/>");
    checkValue(child);
    setOption(context, p.name, child.attribute("value"), child.place("value"));
    return;
  }
  if (const std::string_view name = among(ignored, written); !name.empty()) {
    checkValue(child);
    context.note("accepted and not used: parameter \"" + std::string(name) + "\" of integrator \"" +
                 std::string(plugin.name) + "\"");
    return;
  }
  Names names;
  for (const Parameter& p : plugin.parameters) names.emplace_back(p.name);
  context.problems.tolerate(
      child.place("name"),
      "unknown parameter \"" + written + "\" of integrator \"" + std::string(plugin.name) + "\"",
      "expected a parameter that it has; " + suggestion(written, names));
}

// What is common to all of them is kept of another renderer's method.
void readForeignParameters(ReaderContext& context, const XmlElement& element,
                           const std::string& type) {
  Names unused;
  for (const XmlElement& child : element.children) {
    if (!isParameterElement(child)) continue;
    const std::string written = child.attribute("name");
    if (const std::string_view name = among(kShared, written); !name.empty()) {
      checkValue(child);
      setOption(context, name, child.attribute("value"), child.place("value"));
    } else if (!matches(written, "hideEmitters")) {
      unused.push_back(written);
    }
  }
  if (!unused.empty())
    context.note("accepted and not used: " + joined(unused) + " of integrator \"" + type + "\"");
}

void readHidden(ReaderContext& context, const XmlElement& element) {
  for (const XmlElement& child : element.children)
    if (matches(child.attribute("name"), "hideEmitters")) hideEmitters(context, child);
}

void checkChildren(ReaderContext& context, const XmlElement& element) {
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    const XmlElement& child = element.children[i];
    if (!isParameterElement(child))
      throw sourceError(child.place(), "<" + child.name + "> inside <" + element.name + ">",
                        "expected <boolean>, <integer>, <float> or <string>");
    child.require("name");
    child.allowAttributes({"name", "value"});
    for (std::size_t j = 0; j < i; ++j)
      if (element.children[j].attribute("name") == child.attribute("name"))
        context.problems.tolerate(
            child.place("name"), "parameter \"" + child.attribute("name") + "\" is given twice",
            "first at " + describe(element.children[j].place("name")) + "; the last one counts");
  }
}

void readOwnIntegrator(ReaderContext& context, const XmlElement& element,
                       const IntegratorPlugin& plugin, std::span<const std::string_view> ignored) {
  checkChildren(context, element);
  context.scene.integrator = OptionSet(plugin);
  for (const XmlElement& child : element.children) {
    try {
      readOwnParameter(context, plugin, child, ignored);
    } catch (const SceneError& e) {
      context.problems.add(e);
    }
  }
}

// The integrator inside one that wraps it; null where there is none.
const XmlElement* wrapped(ReaderContext& context, const XmlElement& element) {
  for (const XmlElement& child : element.children) {
    const XmlElement& target = context.resolve(child);
    if (target.name == "integrator") return &target;
  }
  return nullptr;
}

}  // namespace

void readIntegrator(ReaderContext& context, const XmlElement& element,
                    std::span<const IntegratorPlugin> integrators) {
  constexpr int kDeepest = 8;  // wrappers inside each other, which references could make endless
  const XmlElement* inner = &element;
  for (int depth = 0; depth < kDeepest; ++depth) {
    inner->allowAttributes({"type", "id", "name"});
    const std::string type = lowerCase(inner->require("type"));
    if (find(integrators, type) ||
        std::find(std::begin(kWrappers), std::end(kWrappers), type) == std::end(kWrappers))
      break;
    const XmlElement* next = wrapped(context, *inner);
    if (!next) break;
    context.note("integrator \"" + type + "\": the one inside it renders");
    inner = next;
  }

  const std::string type = lowerCase(inner->require("type"));
  const auto foreign = std::find_if(std::begin(kForeign), std::end(kForeign),
                                    [&](const Foreign& entry) { return entry.name == type; });
  const bool known = foreign != std::end(kForeign);
  const IntegratorPlugin* plugin = find(integrators, type);
  if (plugin) {
    std::span<const std::string_view> ignored;
    if (type == "path" || type == "bdpt") ignored = kIgnored;
    if (type == "erpt") ignored = kIgnoredOfErpt;
    readOwnIntegrator(context, *inner, *plugin, ignored);
    readHidden(context, *inner);
    return;
  }
  if (known) plugin = find(integrators, foreign->ours);
  if (plugin) {
    if (!foreign->warning.empty())
      context.problems.warn(
          inner->place("type"),
          "integrator \"" + type + "\" is rendered by \"" + std::string(plugin->name) + "\"",
          std::string(foreign->warning) + "; -i NAME asks for another");
    context.scene.integrator = OptionSet(*plugin);
  } else {
    Names names;
    for (const IntegratorPlugin& p : integrators) names.emplace_back(p.name);
    for (const Foreign& entry : kForeign) names.emplace_back(entry.name);
    context.problems.warn(
        inner->place("type"),
        (known ? "there is no integrator \"" : "unknown integrator \"") + type + "\"",
        "rendered by the one that -i NAME asks for, or else by the default; " +
            suggestion(type, names));
  }
  readForeignParameters(context, *inner, type);
  if (isOneOf(type, {"direct", "direct_projective"}))
    setOption(context, "maxDepth", kDirectDepth, inner->place("type"));
  readHidden(context, *inner);
}

void readDptBlock(ReaderContext& context, const XmlElement& element,
                  std::span<const IntegratorPlugin> integrators) {
  struct Entry {
    std::string_view name, option, type;  // option "": has a meaning of its own, or is tuning
  };
  // How to sample was tuned for another program, whose steps and starts are others: measured on its own scene, its
  // numbers of chains, samples and large steps make ours 1.3 times as noisy. What decides on the picture is taken over.
  static constexpr Entry kEntries[] = {{"integrator", "", "string"},
                                       {"bidirectional", "", "boolean"},
                                       {"h2mc", "", "boolean"},
                                       {"spp", "", "integer"},
                                       {"seedoffset", "", "integer"},
                                       {"numinitsamples", "", "integer"},
                                       {"largestepprob", "", "float"},
                                       {"maxdepth", "maxDepth", "integer"},
                                       {"mindepth", "minDepth", "integer"},
                                       {"directspp", "", "integer"},
                                       {"perturbstddev", "", "float"},
                                       {"lensperturbstddev", "", "float"},
                                       {"lensperturbprob", "", "float"},
                                       {"numchains", "", "integer"},
                                       {"uniformmixprob", "", "float"},
                                       {"roughnessthreshold", "", "float"},
                                       {"reportintervalspp", "", "integer"},
                                       {"uselightcoordinatesampling", "", "boolean"},
                                       {"largestepmultiplexed", "", "boolean"},
                                       {"largestepscale", "", "float"},
                                       {"lensperturbscale", "", "float"},
                                       {"discretestddev", "", "float"},
                                       {"mala", "", "boolean"},
                                       {"samplecache", "", "boolean"}};

  element.allowAttributes({"id"});
  checkChildren(context, element);
  std::map<std::string, const XmlElement*> given;
  Names names;
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  std::string unused;
  for (const XmlElement& child : element.children) {
    const std::string name = lowerCase(child.attribute("name"));
    const auto entry = std::find_if(std::begin(kEntries), std::end(kEntries),
                                    [&](const Entry& e) { return e.name == name; });
    if (entry == std::end(kEntries)) {
      const std::string closest = closestName(name, names);
      if (!closest.empty())
        throw sourceError(child.place("name"), "unknown parameter \"" + name + "\" of <dpt>",
                          suggestion(name, names));
      context.note("accepted and not used: parameter \"" + name + "\" of <dpt>");
      continue;
    }
    if (child.name != entry->type && !(entry->type == "float" && child.name == "integer"))
      throw sourceError(
          child.place(), "parameter \"" + name + "\" of <dpt> is not a <" + child.name + ">",
          "expected <" + std::string(entry->type) + " name=\"" + name + "\" value=\"...\"/>");
    checkValue(child);
    given[name] = &child;
  }
  const auto text = [&](const std::string& name, const std::string& fallback) {
    const auto found = given.find(name);
    return found == given.end() ? fallback
                                : std::string(trimmed(found->second->attribute("value")));
  };

  const std::string method = text("integrator", "mcmc");
  std::string ours;
  if (method == "mcmc") {
    ours = parseBoolean(text("h2mc", "true")) ? "h2mc" : "mmlt";
  } else if (method == "mc") {
    ours = parseBoolean(text("bidirectional", "true")) ? "bdpt" : "path";
  } else {
    throw sourceError(given["integrator"]->place("value"),
                      "unknown integrator \"" + method + "\" of <dpt>",
                      "expected one of the choices; " + suggestion(method, {"mc", "mcmc"}));
  }
  context.scene.options.clear();
  const IntegratorPlugin* plugin = find(integrators, ours);
  context.scene.integrator = plugin ? OptionSet(*plugin) : OptionSet();
  for (const Entry& entry : kEntries) {
    const auto found = given.find(std::string(entry.name));
    if (found == given.end()) continue;
    const XmlElement& child = *found->second;
    if (entry.name == "mindepth" && parseInteger(child.attribute("value")) < 1) continue;
    if (!entry.option.empty()) {
      setOption(context, entry.option, child.attribute("value"), child.place("value"));
    } else if (entry.name == "spp") {
      setOption(context, method == "mcmc" ? "mutationsPerPixel" : "samplesPerPixel",
                child.attribute("value"), child.place("value"));
    } else if (entry.name == "seedoffset") {
      const long long seed = parseInteger(child.attribute("value"));
      if (seed < 0) throw sourceError(child.place("value"), "a seed must not be negative");
      context.scene.seed = static_cast<std::uint64_t>(seed);
    } else if (entry.name != "integrator" && entry.name != "bidirectional" &&
               entry.name != "h2mc") {
      unused += (unused.empty() ? "" : ", ") + std::string(entry.name);
    }
  }
  if (!unused.empty())
    context.note("accepted and not used, tuning for another program: " + unused + " of <dpt>");
}

}  // namespace h2mc
