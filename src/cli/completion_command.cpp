// SPDX-License-Identifier: MIT
// h2mc completion: scripts by which shells complete the program's command line, made from its own tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "cli/command_tree.h"
#include "cli/commands.h"
#include "h2mc_version.h"

namespace h2mc {
namespace {

// Characters of a description in a list beside the option.
constexpr std::size_t kBrief = 70;

std::string replaced(std::string text, char what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, 1, by);
  return text;
}

std::string spaced(const Names& names, const char* separator = " ") {
  return fmt::format("{}", fmt::join(names, separator));
}

// "# bash completion of h2mc 1.2.3, as `h2mc completion bash` prints it."
void printHead(const char* shell) {
  fmt::print("# {0} completion of h2mc {1}, as `h2mc completion {0}` prints it.\n", shell,
             H2MC_VERSION);
}

// The body of a shell's loop over the words before the cursor, by `line`: (command so far, word, command then).
using StepWriter = std::function<void(const std::string&, const std::string&, const std::string&)>;
void forEachStep(const CommandEntry& tree, const StepWriter& step) {
  for (const CommandEntry* command : allCommands(tree))
    for (const CommandEntry& below : command->commands)
      step(command->name, lastWord(below), below.name);
}

namespace bash {

// What adds to COMPREPLY whatever an option's value or an argument may be.
std::string action(const OptionEntry& entry) {
  switch (entry.kind) {
    case ValueKind::kOneOf:
      return fmt::format("_h2mc_add -W '{}'", spaced(entry.choices));
    case ValueKind::kFile:
      return "_h2mc_add -f";
    case ValueKind::kScene:
      return "_h2mc_add -f -X '!*.xml'; _h2mc_add -d";
    case ValueKind::kFolder:
      return "_h2mc_add -d";
    case ValueKind::kNone:
    case ValueKind::kAny:
      break;
  }
  return ":";
}

void printCommand(const CommandEntry& command) {
  fmt::print("    '{}')\n", command.name);
  bool begun = false;
  Names options;
  for (const OptionEntry& option : command.options) {
    options.insert(options.end(), option.names.begin(), option.names.end());
    if (option.kind == ValueKind::kNone) continue;
    if (!begun) fmt::print("      case $before in\n");
    begun = true;
    fmt::print("        {}) {}; return ;;\n", spaced(option.names, " | "), action(option));
  }
  if (begun) fmt::print("      esac\n");
  fmt::print("      options='{}'\n", spaced(options));
  fmt::print("      [[ $word == -* ]] && {{ _h2mc_add -W \"$options\"; return; }}\n");
  if (!command.commands.empty())
    fmt::print("      _h2mc_add -W '{}'\n", spaced(commandNames(command)));
  // Which argument the cursor is at is not counted: all kinds are offered.
  Names actions;
  for (const OptionEntry& argument : command.arguments) {
    const std::string one = action(argument);
    if (one != ":" && std::find(actions.begin(), actions.end(), one) == actions.end())
      actions.push_back(one);
  }
  for (const std::string& one : actions) fmt::print("      {}\n", one);
  fmt::print("      ;;\n");
}

void print(const CommandEntry& tree) {
  printHead("bash");
  fmt::print(R"(
_h2mc_add() {{
  local line
  while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen "$@" -- "$word")
}}

_h2mc() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command='' options i
  COMPREPLY=()
  # bash makes words of --option=value and name:option.
  if [[ $word == = ]]; then word=''
  elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD - 2]}}
  elif [[ $word == : || $before == : ]]; then return
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${{COMP_WORDS[i]}}" in
)");
  forEachStep(tree, [](const std::string& now, const std::string& word, const std::string& then) {
    fmt::print("      '{} {}') command='{}' ;;\n", now, word, then);
  });
  fmt::print(R"(    esac
  done
  compopt -o filenames 2>/dev/null
  case $command in
)");
  for (const CommandEntry* command : allCommands(tree)) printCommand(*command);
  fmt::print("  esac\n}}\n\ncomplete -F _h2mc h2mc\n");
}

}  // namespace bash

namespace zsh {

std::string functionOf(const CommandEntry& command) {
  const std::string name = replaced(replaced(command.name, ' ', "_"), '-', "_");
  return "_h2mc" + (name.empty() ? "" : "_" + name);
}

std::string quoted(const std::string& text) { return "'" + replaced(text, '\'', "'\\''") + "'"; }

// In the brackets of _arguments.
std::string bracketed(const std::string& text) {
  return replaced(replaced(replaced(text, '\\', "\\\\"), '[', "\\["), ']', "\\]");
}

// ":message:action"
std::string value(const OptionEntry& entry) {
  const std::string label = replaced(entry.label, ':', "\\:");
  switch (entry.kind) {
    case ValueKind::kOneOf:
      return fmt::format(":{}:({})", label, spaced(entry.choices));
    case ValueKind::kFile:
      return fmt::format(":{}:_files", label);
    case ValueKind::kScene:
      return fmt::format(":{}:_files -g \"*.xml\"", label);
    case ValueKind::kFolder:
      return fmt::format(":{}:_files -/", label);
    case ValueKind::kAny:
      return fmt::format(":{}: ", label);
    case ValueKind::kNone:
      break;
  }
  return "";
}

// The line of _arguments: '(-o --output)'{-o+,--output=}'[Image to write]:FILE:_files'
std::string line(const OptionEntry& option) {
  Names forms;
  for (const std::string& name : option.names)
    forms.push_back(option.kind == ValueKind::kNone ? name
                                                    : name + (name.starts_with("--") ? "=" : "+"));
  const std::string first = option.repeatable ? "'*'" : fmt::format("'({})'", spaced(option.names));
  const std::string names =
      forms.size() == 1 ? forms.front() : fmt::format("{{{}}}", spaced(forms, ","));
  return first + names +
         quoted("[" + bracketed(brief(option.description, kBrief)) + "]" + value(option));
}

void printCommand(const CommandEntry& command) {
  const bool nested = !command.commands.empty();
  fmt::print("\n{}() {{\n", functionOf(command));
  if (nested) fmt::print("  local curcontext=$curcontext state line\n  typeset -A opt_args\n");
  fmt::print("  _arguments {}", nested ? "-C" : "-S");
  for (const OptionEntry& option : command.options) fmt::print(" \\\n    {}", line(option));
  if (nested) fmt::print(" \\\n    '1:command:->command' '*::argument:->argument'");
  for (const OptionEntry& argument : command.arguments)
    fmt::print(" \\\n    {}", quoted((argument.repeatable ? "*" : "") + value(argument)));
  fmt::print("\n");
  if (nested) {
    fmt::print("  local -a commands\n  commands=(\n");
    for (const CommandEntry& below : command.commands)
      fmt::print("    {}\n", quoted(lastWord(below) + ":" + brief(below.description, kBrief)));
    fmt::print("  )\n  case $state in\n    command) _describe command commands ;;\n");
    fmt::print("    argument)\n      case $words[1] in\n");
    for (const CommandEntry& below : command.commands)
      fmt::print("        {}) {} ;;\n", lastWord(below), functionOf(below));
    fmt::print("      esac\n      ;;\n  esac\n");
  }
  fmt::print("}}\n");
}

void print(const CommandEntry& tree) {
  fmt::print("#compdef h2mc\n");
  printHead("zsh");
  for (const CommandEntry* command : allCommands(tree)) printCommand(*command);
  // By autoload the file is the function's body; sourced, it registers the function.
  fmt::print("\nif [[ $funcstack[1] == _h2mc ]]; then _h2mc \"$@\"; else compdef _h2mc h2mc; fi\n");
}

}  // namespace zsh

namespace fish {

std::string quoted(const std::string& text) {
  return "'" + replaced(replaced(text, '\\', "\\\\"), '\'', "\\'") + "'";
}

void printCommand(const CommandEntry& command) {
  const std::string at = fmt::format("complete -c h2mc -n \"__h2mc_at '{}'\"", command.name);
  for (const CommandEntry& below : command.commands)
    fmt::print("{} -a {} -d {}\n", at, lastWord(below), quoted(brief(below.description, kBrief)));
  for (const OptionEntry& argument : command.arguments) {
    if (argument.kind == ValueKind::kScene)
      fmt::print("{} -k -a '(__fish_complete_suffix .xml)'\n", at);
    else if (argument.kind == ValueKind::kFile)
      fmt::print("{} -F\n", at);
    else if (argument.kind == ValueKind::kFolder)
      fmt::print("{} -a '(__fish_complete_directories)'\n", at);
    else if (argument.kind == ValueKind::kOneOf)
      fmt::print("{} -a {}\n", at, quoted(spaced(argument.choices)));
  }
  for (const OptionEntry& option : command.options) {
    std::string names, value;
    for (const std::string& name : option.names)
      names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (option.kind == ValueKind::kFile)
      value = " -r -F";
    else if (option.kind == ValueKind::kFolder)
      value = " -x -a '(__fish_complete_directories)'";
    else if (option.kind == ValueKind::kOneOf)
      value = " -x -a " + quoted(spaced(option.choices));
    else if (option.kind != ValueKind::kNone)
      value = " -x";
    fmt::print("{}{}{} -d {}\n", at, names, value, quoted(brief(option.description, kBrief)));
  }
}

void print(const CommandEntry& tree) {
  printHead("fish");
  fmt::print(R"(
function __h2mc_at
    set -l command ''
    set -l words (commandline -opc)
    for word in $words[2..-1]
        switch "$command $word"
)");
  forEachStep(tree, [](const std::string& now, const std::string& word, const std::string& then) {
    fmt::print("            case '{} {}'\n                set command '{}'\n", now, word, then);
  });
  fmt::print(R"(        end
    end
    test "$command" = "$argv[1]"
end

complete -c h2mc -f
)");
  for (const CommandEntry* command : allCommands(tree)) printCommand(*command);
}

}  // namespace fish

}  // namespace

void addCompletionCommand(CLI::App& app, Run& run) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "Script by which a shell completes h2mc's command line");
  command->add_option("SHELL", *shell, "Whose")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "`cmake --install` and the package put the scripts where the shells look for them.\n"
      "\n"
      "Examples, for a program that is not installed:\n"
      "  source <(h2mc completion bash)\n"
      "  h2mc completion zsh > ~/.zfunc/_h2mc\n"
      "  h2mc completion fish > ~/.config/fish/completions/h2mc.fish");
  command->callback([shell, &app, &run] {
    run = [shell, &app] {
      const CommandEntry tree = commandTree(app);
      *shell == "bash" ? bash::print(tree) : *shell == "zsh" ? zsh::print(tree) : fish::print(tree);
      return static_cast<int>(kSuccess);
    };
  });
}

}  // namespace h2mc
