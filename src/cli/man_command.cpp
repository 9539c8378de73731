// SPDX-License-Identifier: MIT
// h2mc man: manual pages, made from the program's own tables of options.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include "cli/command_tree.h"
#include "cli/commands.h"
#include "h2mc_version.h"
#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

struct ManOptions {
  std::vector<std::string> command;
  std::string folder;
};

// Text as roff shows it, character for character.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        // A point begins a request where it begins a line.
        if (c == '.' && (result.empty() || result.back() == '\n')) result += "\\&";
        result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string sentence(std::string text) {
  if (!text.empty() && std::string_view(".?!:").find(text.back()) == std::string_view::npos)
    text += '.';
  return text;
}

// "h2mc demo image-copy", and as the page's name "h2mc-demo-image-copy".
std::string fullName(const CommandEntry& command) {
  return command.name.empty() ? "h2mc" : "h2mc " + command.name;
}
std::string pageName(const CommandEntry& command) {
  std::string name = fullName(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string synopsis(const CommandEntry& command) {
  std::string text = bold(fullName(command));
  if (!command.commands.empty()) text += " " + italic("COMMAND");
  for (const OptionEntry& argument : command.arguments) {
    const std::string name = italic(argument.names.front()) + (argument.repeatable ? "..." : "");
    text += argument.required ? " " + name : " [" + name + "]";
  }
  for (const OptionEntry& option : command.options)
    if (option.required) text += " " + bold(option.names.front()) + " " + italic(option.label);
  return text + " [" + italic("OPTION") + "...]";
}

std::string described(const OptionEntry& entry) {
  std::string text = roff(sentence(entry.description));
  if (!entry.range.empty()) text += " From " + roff(entry.range) + ".";
  if (!entry.fallback.empty()) text += " Default: " + roff(entry.fallback) + ".";
  if (entry.kind == ValueKind::kOneOf && entry.label.find('|') == std::string::npos)
    text += " Names: " + roff(fmt::format("{}", fmt::join(entry.choices, ", "))) + ".";
  return text;
}

std::string tagged(const OptionEntry& entry) {
  std::string names;
  for (const std::string& name : entry.names) {
    const std::string shown = name.starts_with('-') ? bold(name) : italic(name);
    names += (names.empty() ? "" : ", ") + shown;
  }
  if (!entry.label.empty() && entry.names.front().starts_with('-'))
    names += " " + italic(entry.label);
  return ".TP\n" + names + "\n" + described(entry) + "\n";
}

// Paragraphs are filled; what is indented, or is a list with two columns, stays as it is.
std::string notes(const std::string& footer) {
  std::string text;
  bool asItIs = false, begun = false;
  const auto keep = [&](bool wish) {
    if (wish != asItIs) text += wish ? ".PP\n.nf\n" : ".fi\n";
    asItIs = wish;
  };
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      keep(false);
      if (begun) text += ".PP\n";
      begun = false;
      continue;
    }
    keep(line.starts_with("  "));
    text += roff(line) + "\n";
    begun = true;
  }
  keep(false);
  return text;
}

std::string pageOf(const CommandEntry& command, const CommandEntry& tree) {
  std::string upper = pageName(command);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string text =
      fmt::format(".TH {} 1 \"\" \"h2mc {}\" \"User Commands\"\n", roff(upper), H2MC_VERSION);
  text += ".nh\n.ad l\n";  // names of options stay whole, for who looks for them
  std::string line = sentence(command.description);
  line.pop_back();
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(pageName(command)), roff(line));
  text += ".SH SYNOPSIS\n" + synopsis(command) + "\n";
  text += ".SH DESCRIPTION\n" + roff(sentence(command.description)) + "\n";
  if (!command.arguments.empty()) {
    text += ".SH ARGUMENTS\n";
    for (const OptionEntry& argument : command.arguments) text += tagged(argument);
  }
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const CommandEntry& below : command.commands)
      text +=
          fmt::format(".TP\n{}\n{}\n", bold(lastWord(below)), roff(sentence(below.description)));
  }
  text += ".SH OPTIONS\n";
  for (const OptionEntry& option : command.options) text += tagged(option);
  if (!command.footer.empty()) text += ".SH NOTES\n" + notes(command.footer);
  text += ".SH SEE ALSO\n";
  std::string others;
  for (const CommandEntry* other : allCommands(tree))
    if (other != &command)
      others += fmt::format("{}{}(1)", others.empty() ? "" : ",\n", bold(pageName(*other)));
  return text + others + "\n";
}

int man(const ManOptions& options, const CLI::App& app) {
  const CommandEntry tree = commandTree(app);
  if (!options.folder.empty()) {
    if (!options.command.empty())
      throw InputError("-o writes the pages of all commands: give no COMMAND with it");
    const std::filesystem::path folder = options.folder;
    prepareFolder(folder, pageName(tree) + ".1");
    for (const CommandEntry* command : allCommands(tree))
      writeTextAtomically((folder / (pageName(*command) + ".1")).string(), pageOf(*command, tree));
    return kSuccess;
  }
  const std::string wanted = fmt::format("{}", fmt::join(options.command, " "));
  Names known;
  for (const CommandEntry* command : allCommands(tree)) {
    if (command->name == wanted) {
      fmt::print("{}", pageOf(*command, tree));
      return kSuccess;
    }
    if (!command->name.empty()) known.push_back(command->name);
  }
  throw InputError("unknown command \"" + wanted + "\"; " + suggestion(wanted, known));
}

}  // namespace

void addManCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<ManOptions>();
  CLI::App* command = app.add_subcommand("man", "Manual page of a command");
  command->add_option("COMMAND", options->command, "Default: the page of h2mc itself");
  command->add_option("-o,--output", options->folder, "Folder to write the pages of all to")
      ->type_name("DIR");
  command->footer(
      "`cmake --install` and the package put the pages where `man` looks for them.\n"
      "\n"
      "Example, for a program that is not installed:\n"
      "  man <(h2mc man render)");
  command->callback(
      [options, &app, &run] { run = [options, &app] { return man(*options, app); }; });
}

}  // namespace h2mc
