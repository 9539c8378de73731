// h2mc list
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cli/commands.h"
#include "mcmc/integrators.h"
#include "render/bsdf/bsdf.h"
#include "render/light/light.h"
#include "render/scene/shape_plugins.h"
#include "render/scene/suggestion.h"
#include "render/texture/texture.h"

namespace h2mc {
namespace {

// A row of any of the plugin tables.
struct Entry {
  std::string_view name, otherName, description;
  std::span<const Parameter> parameters;
};

struct Section {
  const char* name;
  std::vector<Entry> entries;
};

std::vector<Section> sections() {
  std::vector<Section> all{
      {"bsdfs", {}}, {"lights", {}}, {"shapes", {}}, {"textures", {}}, {"integrators", {}}};
  for (const BsdfPlugin& p : bsdfPlugins())
    all[0].entries.push_back({p.name, "", p.description, p.parameters});
  for (const auto& p : lightPlugins())
    all[1].entries.push_back({p.name, p.otherName, p.description, p.parameters});
  for (const auto& p : shapePlugins())
    all[2].entries.push_back({p.name, p.otherName, p.description, p.parameters});
  for (const auto& p : texturePlugins())
    all[3].entries.push_back({p.name, p.otherName, p.description, p.parameters});
  for (const IntegratorFactory& f : allIntegrators())
    all[4].entries.push_back({f.plugin.name, "", f.plugin.description, f.plugin.parameters});
  return all;
}

std::string typeName(const Parameter& parameter) {
  switch (parameter.type) {
    case ParameterType::kBoolean:
      return "boolean";
    case ParameterType::kInteger:
      return "integer";
    case ParameterType::kNumber:
      return "number";
    case ParameterType::kString:
      return "string";
    case ParameterType::kColor:
      return "colour";
    case ParameterType::kTexture:
      return "texture";
    case ParameterType::kPoint:
      return "point";
    case ParameterType::kVector:
      return "vector";
    case ParameterType::kTransform:
      return "transform";
  }
  return "?";
}

std::string describe(const Parameter& parameter) {
  std::string text(parameter.description);
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!parameter.choices.empty()) {
    std::string choices(parameter.choices);
    for (std::size_t at = 0; (at = choices.find('|', at)) != std::string::npos; at += 2)
      choices.replace(at, 1, ", ");
    add("one of " + choices);
  }
  if (!parameter.otherName.empty()) add("also " + std::string(parameter.otherName));
  return text;
}

constexpr std::size_t kColumns = 100;

// Prints `head`, then `text` word by word, further lines starting below it.
void printWrapped(const std::string& head, const std::string& text) {
  std::string line = head;
  std::size_t begin = 0;
  bool empty = true;  // no word on this line yet
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!empty && line.size() + 1 + word.size() > kColumns) {
      fmt::print("{}\n", line);
      line.assign(head.size(), ' ');
      empty = true;
    }
    line += (empty ? "" : " ") + word;
    empty = false;
    begin = end + 1;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  fmt::print("{}\n", line);
}

void print(const Entry& entry) {
  fmt::print("  {}{}\n", entry.name,
             entry.otherName.empty() ? "" : fmt::format(" (also {})", entry.otherName));
  if (!entry.description.empty()) printWrapped("      ", std::string(entry.description));
  std::size_t name = 0, type = 0, fallback = 1;
  Names ignored;
  for (const Parameter& p : entry.parameters) {
    if (p.ignored) {
      ignored.emplace_back(p.name);
      continue;
    }
    name = std::max(name, p.name.size());
    type = std::max(type, typeName(p).size());
    fallback = std::max(fallback, p.fallback.size());
  }
  for (const Parameter& p : entry.parameters)
    if (!p.ignored)
      printWrapped(fmt::format("    {:<{}}  {:<{}}  {:<{}}  ", p.name, name, typeName(p), type,
                               p.fallback.empty() ? "-" : p.fallback, fallback),
                   describe(p));
  if (!ignored.empty()) printWrapped("    read and not used: ", joined(ignored));
}

int list(const std::string& what) {
  Names names;
  bool found = what.empty();
  for (const Section& section : sections()) {
    names.emplace_back(section.name);
    const bool whole = what.empty() || what == section.name;
    std::vector<Entry> chosen;
    for (const Entry& entry : section.entries)
      if (whole || entry.name == what || (!what.empty() && entry.otherName == what))
        chosen.push_back(entry);
    if (chosen.empty() && !whole) continue;
    found = true;
    fmt::print("{}\n", section.name);
    for (const Entry& entry : chosen) print(entry);
  }
  if (!found)
    throw InputError("nothing is called \"" + what + "\"; give one of " + joined(names) +
                     ", or the name of one of their entries");
  return kSuccess;
}

}  // namespace

void addListCommand(CLI::App& app, Run& run) {
  auto what = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "list", "BSDFs, lights, shapes, textures and integrators, with their parameters");
  command->add_option("WHAT", *what,
                      "bsdfs, lights, shapes, textures, integrators, or the name of one of their "
                      "entries; default: everything");
  command->footer("Columns: name, type, default (- where there is none), meaning.");
  command->callback([what, &run] { run = [what] { return list(*what); }; });
}

}  // namespace h2mc
