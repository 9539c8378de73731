// The <integrator> of a scene and dpt's <dpt>, in terms of our integrators' options.
#include <algorithm>
#include <charconv>

#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

// What Mitsuba calls its integrators; "" where none of ours does the same.
constexpr std::pair<std::string_view, std::string_view> kMitsuba[] = {
    {"path", "path"},     {"volpath", "path"},  {"volpath_simple", "path"},
    {"direct", ""},       {"bdpt", "bdpt"},     {"mlt", ""},
    {"pssmlt", ""},       {"erpt", ""},         {"ptracer", ""},
    {"photonmapper", ""}, {"ppm", ""},          {"sppm", ""},
    {"vpl", ""},          {"ao", ""},           {"adaptive", ""},
    {"irrcache", ""},     {"multichannel", ""}, {"field", ""},
    {"aov", ""},          {"prb", ""}};

// Parameters of Mitsuba's integrators that mean what an option of ours means.
constexpr std::pair<std::string_view, std::string_view> kShared[] = {{"maxDepth", "maxDepth"},
                                                                     {"rrDepth", "rrDepth"}};

// Parameters of Mitsuba's path and bdpt that ours have no option for.
constexpr std::string_view kIgnored[] = {"strictNormals", "hideEmitters", "lightImage",
                                         "sampleDirect"};

const IntegratorPlugin* find(std::span<const IntegratorPlugin> integrators, std::string_view name) {
  for (const IntegratorPlugin& plugin : integrators)
    if (plugin.name == name) return &plugin;
  return nullptr;
}

// Sets an option for the chosen integrator, if it has it, and for any other.
void setOption(ReaderContext& context, std::string_view name, const std::string& value,
               const SourcePlace& place) {
  context.scene.options[std::string(name)] = value;
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

void readOwnParameter(ReaderContext& context, const IntegratorPlugin& plugin,
                      const XmlElement& child, bool isMitsubas) {
  const std::string& written = child.require("name");
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
  if (isMitsubas) {
    for (std::string_view name : kIgnored) {
      if (!matches(written, name)) continue;
      checkValue(child);
      context.note("accepted and not used: parameter \"" + std::string(name) +
                   "\" of integrator \"" + std::string(plugin.name) + "\"");
      return;
    }
  }
  Names names;
  for (const Parameter& p : plugin.parameters) names.emplace_back(p.name);
  throw sourceError(
      child.place("name"),
      "unknown parameter \"" + written + "\" of integrator \"" + std::string(plugin.name) + "\"",
      "expected a parameter that it has; " + suggestion(written, names));
}

void checkChildren(const XmlElement& element) {
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    const XmlElement& child = element.children[i];
    if (!isParameterElement(child))
      throw sourceError(child.place(), "<" + child.name + "> inside <" + element.name + ">",
                        "expected <boolean>, <integer>, <float> or <string>");
    child.require("name");
    child.allowAttributes({"name", "value"});
    for (std::size_t j = 0; j < i; ++j)
      if (element.children[j].attribute("name") == child.attribute("name"))
        throw sourceError(child.place("name"),
                          "parameter \"" + child.attribute("name") + "\" is given twice",
                          "first at " + describe(element.children[j].place("name")));
  }
}

}  // namespace

void readIntegrator(ReaderContext& context, const XmlElement& element,
                    std::span<const IntegratorPlugin> integrators) {
  element.allowAttributes({"type", "id", "name"});
  const std::string type = lowerCase(element.require("type"));
  const auto mitsuba = std::find_if(std::begin(kMitsuba), std::end(kMitsuba),
                                    [&](const auto& entry) { return entry.first == type; });
  const bool isMitsubas = mitsuba != std::end(kMitsuba);
  const IntegratorPlugin* plugin = find(integrators, type);
  if (!plugin && isMitsubas && !mitsuba->second.empty())
    plugin = find(integrators, mitsuba->second);
  if (plugin) {
    checkChildren(element);
    context.scene.integrator = OptionSet(*plugin);
    for (const XmlElement& child : element.children)
      readOwnParameter(context, *plugin, child, isMitsubas);
    return;
  }
  if (!isMitsubas) {
    Names names;
    for (const IntegratorPlugin& p : integrators) names.emplace_back(p.name);
    for (const auto& [name, ours] : kMitsuba)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
    throw sourceError(element.place("type"), "unknown integrator \"" + type + "\"",
                      "expected an integrator of ours or of Mitsuba's; " + suggestion(type, names));
  }
  // Another renderer's method: what is common to all is kept.
  std::string kept;
  for (const XmlElement& child : element.children) {
    const std::string written = child.attribute("name");
    for (const auto& [theirs, ours] : kShared) {
      if (!matches(written, theirs)) continue;
      checkValue(child);
      setOption(context, ours, child.attribute("value"), child.place("value"));
      kept += (kept.empty() ? " but " : ", ") + std::string(ours);
    }
  }
  context.note("accepted and not used: integrator \"" + type + "\"" +
               (kept.empty() ? "" : " and its parameters" + kept));
}

void readDptBlock(ReaderContext& context, const XmlElement& element,
                  std::span<const IntegratorPlugin> integrators) {
  struct Entry {
    std::string_view name, option, type;  // option "": has a meaning of its own, or none
  };
  static constexpr Entry kEntries[] = {{"integrator", "", "string"},
                                       {"bidirectional", "", "boolean"},
                                       {"h2mc", "", "boolean"},
                                       {"spp", "", "integer"},
                                       {"seedoffset", "", "integer"},
                                       {"numinitsamples", "bootstrapSamples", "integer"},
                                       {"largestepprob", "largeStepProbability", "float"},
                                       {"maxdepth", "maxDepth", "integer"},
                                       {"mindepth", "minDepth", "integer"},
                                       {"directspp", "directSamples", "integer"},
                                       {"perturbstddev", "sigma", "float"},
                                       {"lensperturbstddev", "lensSigma", "float"},
                                       {"lensperturbprob", "lensProbability", "float"},
                                       {"numchains", "chains", "integer"},
                                       {"uniformmixprob", "isotropicProbability", "float"},
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
  checkChildren(element);
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
  if (!unused.empty()) context.note("accepted and not used: " + unused + " of <dpt>");
}

}  // namespace h2mc
