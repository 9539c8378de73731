// SPDX-License-Identifier: MIT
// The commands and their options as the command line's parser holds them, for what is made of them: shell completion,
// manual pages, suggestions.
#pragma once

#include <string>
#include <vector>

#include "render/scene/suggestion.h"

namespace CLI {
class App;
}

namespace h2mc {

// What an option's type name says of its values: see type_name() where the option is declared.
enum class ValueKind {
  kNone,    // a flag
  kAny,     // numbers, text
  kOneOf,   // OptionEntry::choices
  kFile,    // FILE
  kScene,   // FILE of an argument SCENE: *.xml
  kFolder,  // DIR
};

// An option, or an argument that has no name before it.
struct OptionEntry {
  Names names;        // "-o", "--output"; of an argument: its one name
  std::string label;  // of the value: "FILE"; empty for flags
  ValueKind kind = ValueKind::kNone;
  // kOneOf: those that are offered; with INTEGRATOR options may follow.
  Names choices;
  std::string description, range, fallback;  // range: "0 to 1"; empty where there is none
  bool required = false, repeatable = false;
};

struct CommandEntry {
  std::string name;  // all words of it after "h2mc": "", "render", "demo image-copy"
  std::string description, footer;
  std::vector<OptionEntry> arguments, options;
  std::vector<CommandEntry> commands;
};

// The whole program. Commands that are hidden from --help are left out.
CommandEntry commandTree(const CLI::App& app);

// The command and all below it, each before what is below.
std::vector<const CommandEntry*> allCommands(const CommandEntry& tree);

// The last word of its name.
std::string lastWord(const CommandEntry& command);

// The names of its commands.
Names commandNames(const CommandEntry& command);

// "--width" and the like.
Names longOptions(const CommandEntry& command);

// The first part of a description, for a line in a list. Not longer than `most`.
std::string brief(const std::string& description, std::size_t most);

}  // namespace h2mc
