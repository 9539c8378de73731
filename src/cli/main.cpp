// SPDX-License-Identifier: MIT
// h2mc: Metropolis light transport steered by derivatives. The commands are in the files beside
// this one.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "cli/command_tree.h"
#include "cli/commands.h"
#include "cli/join_ranks.h"
#include "compare/comparison.h"
#include "h2mc_version.h"
#include "inspect/inspect.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/scene/properties.h"
#include "render/scene/scene.h"
#include "render/scene/suggestion.h"

namespace h2mc {

void printWarnings(const Scene& scene) {
  for (const std::string& warning : scene.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
}

void checkWritableFile(const std::string& file) {
  if (file.empty()) return;
  try {
    AtomicFile probe(file);
  } catch (const std::exception& e) {
    throw InputError(e.what());
  }
}

void checkDistinct(const std::vector<std::pair<const char*, std::string>>& files) {
  std::map<std::filesystem::path, const char*> known;
  for (const auto& [what, file] : files) {
    if (file.empty()) continue;
    std::error_code error;  // whoever opens the file says what is wrong with it
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, error);
    if (error) continue;
    const auto [other, isNew] = known.emplace(path, what);
    if (!isNew)
      throw InputError(std::string(other->second) + " and " + what + " are one file, \"" + file +
                       "\"");
  }
}

bool prepareFolder(const std::filesystem::path& folder, const std::string& file) {
  std::error_code error;
  const bool made = std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("cannot make the folder \"" + folder.string() + "\": " + error.message());
  checkWritableFile((folder / file).string());
  return made;
}

namespace {

// Of several processes that were started together one talks.
int report(int exitCode, const char* message) {
  if (rankPlace().talks()) std::fprintf(stderr, "h2mc: %s\n", message);
  letFirstEnd();
  return exitCode;
}

// What stdout holds back until the end may fail too: a full disk must not look like success.
int flushed(int exitCode) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return exitCode;
  return report(kFailed, "cannot write to stdout: is the disk full?");
}

// The command in which parsing went wrong, for the hint.
std::string commandName(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? "h2mc" : "h2mc " + parsed.front()->get_name();
}

// What went wrong in parsing; for an option that the command does not have, those that it has.
std::string messageOf(const CLI::ParseError& error, const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !parsed.empty()) {
    const Names known = longOptions(commandTree(*parsed.front()));
    for (const std::string& given : parsed.front()->remaining(true))
      if (given.starts_with("--"))
        return "unknown option \"" + given + "\"; " +
               suggestion(given.substr(0, given.find('=')), known);
  }
  return error.what();
}

int run(int argc, char** argv) {
  CLI::App app{"Renders scenes by Metropolis light transport steered by derivatives.", "h2mc"};
  app.set_version_flag("--version", "h2mc " H2MC_VERSION_STRING, "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(0, 1);  // that there has to be one is said below
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "`h2mc COMMAND --help` explains a command's options.\n"
      "Exit codes: 0 done, 1 a check failed (diff --tolerance, gradcheck, stress) or a pixel is\n"
      "dark (inspect), 2 wrong input, 3 any other failure, 130 interrupted.");
  Run command;
  addRenderCommand(app, command);
  addRerenderCommand(app, command);
  addInfoCommand(app, command);
  addListCommand(app, command);
  addDiffCommand(app, command);
  addGradcheckCommand(app, command);
  addStressCommand(app, command);
  addCompareCommand(app, command);
  addDemoCommand(app, command);
  addInspectCommand(app, command);
  addMergeCommand(app, command);
  addConvertCommand(app, command);
  addCompletionCommand(app, command);
  addManCommand(app, command);

  Names commands;
  for (const CLI::App* each : app.get_subcommands({})) commands.push_back(each->get_name());
  const std::string first = argc > 1 ? argv[1] : "";
  const bool known = std::find(commands.begin(), commands.end(), first) != commands.end();
  if (!first.empty() && first[0] != '-' && !known)
    return report(kBadInput,
                  ("unknown command \"" + first + "\"; " + suggestion(first, commands)).c_str());

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    return report(kBadInput,
                  (messageOf(e, app) + "\nTry `" + commandName(app) + " --help`.").c_str());
  }

  if (!command) return report(kBadInput, ("which command? available: " + joined(commands)).c_str());

  // Those whose run() joins the others.
  const Names together{"render", "rerender"};
  if (!rankPlace().alone() && std::find(together.begin(), together.end(), first) == together.end())
    return report(kBadInput, ("several processes can " + joined(together) + " together; \"" +
                              first + "\" is for one alone")
                                 .c_str());

  try {
    return command();
  } catch (const UserError& e) {
    return report(kBadInput, e.what());
  }
}

}  // namespace
}  // namespace h2mc

int main(int argc, char** argv) {
  try {
    // Messages go to stderr: stdout is for data.
    spdlog::set_default_logger(spdlog::stderr_color_mt("h2mc"));
    spdlog::set_pattern("h2mc: %v");
    return h2mc::flushed(h2mc::run(argc, argv));
  } catch (const std::bad_alloc&) {
    return h2mc::report(h2mc::kFailed, "out of memory");
  } catch (const std::exception& e) {
    return h2mc::report(h2mc::kFailed, e.what());
  }
}
