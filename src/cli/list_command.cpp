// SPDX-License-Identifier: MIT
// h2mc list
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "cli/commands.h"
#include "mcmc/methods/presets.h"
#include "mcmc/mutations/mutations.h"
#include "mcmc/render/integrators.h"
#include "render/bsdf/bsdf.h"
#include "render/light/light.h"
#include "render/scene/sensor_plugins.h"
#include "render/scene/shape_plugins.h"
#include "render/scene/suggestion.h"
#include "render/texture/texture.h"

namespace h2mc {
namespace {

// A row of any of the plugin tables.
struct Entry {
  std::string_view name, otherName;
  std::string description;
  std::span<const Parameter> parameters;
};

struct Section {
  const char* name;
  std::vector<Entry> entries;
};

// The words of a preset, and what it sets.
std::string optionsOf(const Preset& preset) {
  std::string text = fmt::format("{}. Stands for {}", preset.description, preset.method);
  for (std::size_t i = 0; i < preset.options.size(); ++i)
    text +=
        fmt::format("{}{}={}", i ? "," : ":", preset.options[i].first, preset.options[i].second);
  return text;
}

std::vector<Section> sections() {
  std::vector<Section> all{
      {"bsdfs", {}},     {"lights", {}},  {"shapes", {}},  {"textures", {}}, {"integrators", {}},
      {"mutations", {}}, {"presets", {}}, {"sensors", {}}, {"films", {}},    {"filters", {}}};
  for (const BsdfPlugin& p : bsdfPlugins())
    all[0].entries.push_back({p.name, "", std::string(p.description), p.parameters});
  for (const auto& p : lightPlugins())
    all[1].entries.push_back({p.name, p.otherName, std::string(p.description), p.parameters});
  for (const auto& p : shapePlugins())
    all[2].entries.push_back({p.name, p.otherName, std::string(p.description), p.parameters});
  for (const auto& p : texturePlugins())
    all[3].entries.push_back({p.name, p.otherName, std::string(p.description), p.parameters});
  for (const IntegratorFactory& f : allIntegrators())
    all[4].entries.push_back(
        {f.plugin.name, "", std::string(f.plugin.description), f.plugin.parameters});
  for (const MutationPlugin& p : mutations())
    all[5].entries.push_back({p.name, "", std::string(p.description), p.parameters});
  for (const LargeStepPlugin& p : largeSteps())
    all[5].entries.push_back(
        {p.name, "", fmt::format("large step: {}", p.description), p.parameters});
  for (const Preset& p : presets()) all[6].entries.push_back({p.name, "", optionsOf(p), {}});
  const auto addAll = [](Section& section, std::span<const SensorPlugin> plugins) {
    for (const SensorPlugin& p : plugins)
      section.entries.push_back({p.name, "", std::string(p.description), p.parameters});
  };
  addAll(all[7], sensorPlugins());
  addAll(all[8], filmPlugins());
  addAll(all[9], filterPlugins());
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
  if (!entry.description.empty()) printWrapped("      ", entry.description);
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

// What Markdown shows as this text, in a cell of a table too.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') result += '\\';
    result += c;
  }
  return result;
}

// As code in a cell, which a bar would end.
std::string codeCell(std::string_view text) {
  std::string result = "`";
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return text.empty() ? "" : result + "`";
}

void printMarkdown(const Entry& entry) {
  fmt::print("\n### {}\n\n", entry.name);
  std::string text = escaped(entry.description);
  if (!entry.otherName.empty())
    text += fmt::format("{}Also `{}`.", text.empty() ? "" : " ", entry.otherName);
  if (!text.empty()) fmt::print("{}\n", text);
  Names ignored;
  bool begun = false;
  for (const Parameter& p : entry.parameters) {
    if (p.ignored) {
      ignored.emplace_back(fmt::format("`{}`", p.name));
      continue;
    }
    if (!begun) fmt::print("\n| parameter | type | default | meaning |\n|---|---|---|---|\n");
    begun = true;
    fmt::print("| `{}` | {} | {} | {} |\n", p.name, typeName(p), codeCell(p.fallback),
               escaped(describe(p)));
  }
  if (!ignored.empty()) fmt::print("\nRead and not used: {}.\n", joined(ignored));
}

int list(const std::string& what, bool markdown) {
  Names names;
  bool found = what.empty();
  const char* gap = "";
  for (const Section& section : sections()) {
    names.emplace_back(section.name);
    const bool whole = what.empty() || what == section.name;
    std::vector<Entry> chosen;
    for (const Entry& entry : section.entries)
      if (whole || entry.name == what || (!what.empty() && entry.otherName == what))
        chosen.push_back(entry);
    if (chosen.empty() && !whole) continue;
    found = true;
    if (markdown)
      fmt::print("{}## {}\n", std::exchange(gap, "\n"), section.name);
    else
      fmt::print("{}\n", section.name);
    for (const Entry& entry : chosen) markdown ? printMarkdown(entry) : print(entry);
  }
  if (!found)
    throw InputError("nothing is called \"" + what + "\"; give one of " + joined(names) +
                     ", or the name of one of their entries");
  return kSuccess;
}

}  // namespace

Names listSections() {
  Names names;
  for (const Section& section : sections()) names.emplace_back(section.name);
  return names;
}

void addListCommand(CLI::App& app, Run& run) {
  auto what = std::make_shared<std::string>();
  auto markdown = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("list",
                         "BSDFs, lights, shapes, textures, integrators, mutations, presets, "
                         "sensors, films and filters, with their parameters");
  command
      ->add_option("WHAT", *what,
                   "bsdfs, lights, shapes, textures, integrators, mutations, presets, sensors, "
                   "films, filters, or the "
                   "name of one of their entries; default: everything")
      ->type_name("SECTION");
  command->add_flag("--markdown", *markdown, "as Markdown tables, those of docs/scene-format.md");
  command->footer("Columns: name, type, default (- where there is none), meaning.");
  command->callback(
      [what, markdown, &run] { run = [what, markdown] { return list(*what, *markdown); }; });
}

}  // namespace h2mc
