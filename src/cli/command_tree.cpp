// SPDX-License-Identifier: MIT
#include "cli/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "cli/commands.h"
#include "mcmc/methods/presets.h"
#include "mcmc/render/integrators.h"
#include "render/image/metrics.h"
#include "render/integrator/layers.h"

namespace h2mc {
namespace {

// The names that an option of this type may have for its value.
Names namesOfType(const std::string& type) {
  Names names;
  if (type == "INTEGRATOR") {
    for (const IntegratorFactory& factory : allIntegrators())
      names.emplace_back(factory.plugin.name);
    for (const Preset& preset : presets()) names.emplace_back(preset.name);
  } else if (type == "METRIC") {
    for (const Metric& metric : metrics()) names.emplace_back(metric.name);
    names.emplace_back("all");
  } else if (type == "SECTION") {
    names = listSections();
  } else if (type == "LAYERS") {
    names = layerKindNames();
  }
  return names;
}

Names split(const std::string& text, char separator) {
  Names parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// CLI11 has the type's name and its checks' descriptions in one text: "TEXT:{signed,relative}", "INT:INT in [1 - 32]",
// "TEXT:DIR".
void readType(const CLI::Option& option, OptionEntry& entry) {
  if (option.get_items_expected_max() == 0) return;
  const std::string whole = option.get_type_name();
  entry.label = whole.substr(0, whole.find(':'));
  const std::string checks =
      entry.label.size() < whole.size() ? whole.substr(entry.label.size() + 1) : "";
  entry.kind = ValueKind::kAny;
  entry.choices = namesOfType(entry.label);
  const std::size_t low = checks.find(" in [");
  if (checks.starts_with('{') && checks.ends_with('}')) {
    entry.choices = split(checks.substr(1, checks.size() - 2), ',');
    entry.label = checks.substr(1, checks.size() - 2);
    std::replace(entry.label.begin(), entry.label.end(), ',', '|');
  } else if (low != std::string::npos && checks.ends_with(']')) {
    entry.range = checks.substr(low + 5, checks.size() - low - 6);
    const std::size_t dash = entry.range.find(" - ");
    if (dash != std::string::npos) entry.range.replace(dash, 3, " to ");
  }
  if (!entry.choices.empty())
    entry.kind = ValueKind::kOneOf;
  else if (entry.label == "DIR" || checks == "DIR")
    entry.kind = ValueKind::kFolder;
  else if (entry.label == "FILE")
    entry.kind = entry.names.front() == "SCENE" ? ValueKind::kScene : ValueKind::kFile;
  if (entry.kind == ValueKind::kFolder) entry.label = "DIR";
}

OptionEntry entryOf(const CLI::Option& option) {
  OptionEntry entry;
  if (option.get_positional()) {
    entry.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  }
  readType(option, entry);
  entry.description = option.get_description();
  if (entry.kind != ValueKind::kNone) entry.fallback = option.get_default_str();
  entry.required = option.get_required();
  entry.repeatable = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
  return entry;
}

// With those of its groups, which are commands without a name to the parser.
void addOptions(const CLI::App& app, CommandEntry& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? command.arguments : command.options).push_back(entryOf(*option));
  }
  for (const CLI::App* below : app.get_subcommands({}))
    if (below->get_name().empty()) addOptions(*below, command);
}

CommandEntry commandOf(const CLI::App& app, const std::string& name) {
  CommandEntry command;
  command.name = name;
  command.description = app.get_description();
  // Without one of its own a command has that of the one above it.
  if (!app.get_parent() || app.get_footer() != app.get_parent()->get_footer())
    command.footer = app.get_footer();
  addOptions(app, command);
  for (const CLI::App* below : app.get_subcommands({}))
    if (!below->get_name().empty() && !below->get_group().empty())
      command.commands.push_back(
          commandOf(*below, name + (name.empty() ? "" : " ") + below->get_name()));
  return command;
}

}  // namespace

CommandEntry commandTree(const CLI::App& app) { return commandOf(app, ""); }

std::vector<const CommandEntry*> allCommands(const CommandEntry& tree) {
  std::vector<const CommandEntry*> all{&tree};
  for (const CommandEntry& below : tree.commands)
    for (const CommandEntry* command : allCommands(below)) all.push_back(command);
  return all;
}

std::string lastWord(const CommandEntry& command) {
  return command.name.substr(command.name.rfind(' ') + 1);
}

Names commandNames(const CommandEntry& command) {
  Names names;
  for (const CommandEntry& below : command.commands) names.push_back(lastWord(below));
  return names;
}

Names longOptions(const CommandEntry& command) {
  Names names;
  for (const OptionEntry& option : command.options)
    for (const std::string& name : option.names)
      if (name.starts_with("--")) names.push_back(name);
  return names;
}

std::string brief(const std::string& description, std::size_t most) {
  std::string text = description;
  for (const char* end : {". ", "; "}) text = text.substr(0, text.find(end));
  if (text.size() <= most) return text;
  return text.substr(0, text.rfind(' ', most - 3)) + "...";
}

}  // namespace h2mc
