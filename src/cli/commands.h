// SPDX-License-Identifier: MIT
// The program's commands. Each is one file; they share only what is declared here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mcmc/render/integrators.h"
#include "render/core/user_error.h"
#include "render/scene/option_set.h"
#include "render/scene/problems.h"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace h2mc {

struct ReadOptions;
struct Scene;

enum ExitCode {
  kSuccess = 0,
  kCheckFailed = 1,  // diff, gradcheck: more than the tolerance; stress: a defect; inspect: dark
  kBadInput = 2,     // options, scene, images, paths
  kFailed = 3,       // anything else: memory, disk, a mistake in the program
  kInterrupted = 130,
};

// The user's input is wrong; what() is the whole message.
class InputError : public UserError {
 public:
  using UserError::UserError;
};

// Each declares a subcommand. When the command line names it, `run` becomes what executes it and
// returns the exit code.
using Run = std::function<int()>;
void addRenderCommand(CLI::App& app, Run& run);
void addRerenderCommand(CLI::App& app, Run& run);
void addConvertCommand(CLI::App& app, Run& run);
void addInfoCommand(CLI::App& app, Run& run);
void addListCommand(CLI::App& app, Run& run);
void addDiffCommand(CLI::App& app, Run& run);
void addGradcheckCommand(CLI::App& app, Run& run);
void addStressCommand(CLI::App& app, Run& run);
void addCompareCommand(CLI::App& app, Run& run);
void addDemoCommand(CLI::App& app, Run& run);
void addInspectCommand(CLI::App& app, Run& run);
void addMergeCommand(CLI::App& app, Run& run);
// These print what the others consist of, when they run: `app` has to live until then.
void addCompletionCommand(CLI::App& app, Run& run);
void addManCommand(CLI::App& app, Run& run);

// What `h2mc list` can list.
std::vector<std::string> listSections();

// The option -D of the commands that read a scene.
void addDefines(CLI::App& command, std::vector<std::string>& definitions);
// What `-D name=value` means to the commands that read a scene. Throws InputError.
std::map<std::string, std::string> parseDefines(const std::vector<std::string>& definitions);

// The option --permissive of the same commands.
void addPermissive(CLI::App& command, bool& permissive);
Strictness strictnessOf(bool permissive);

// The option --confine of the same commands.
void addConfine(CLI::App& command, std::string& folder);

// What these three mean to the reader, with the integrators that there are.
ReadOptions readOptionsOf(const std::vector<std::string>& defines, bool permissive,
                          const std::string& confine);

// Of options: a finite number above 0.
CLI::Validator positiveNumber();

// The options --seed and --threads.
void addSeed(CLI::App& command, std::uint64_t& seed, const std::string& description);
void addSeed(CLI::App& command, std::optional<std::uint64_t>& seed, const std::string& description);
inline constexpr int kMostThreads = 1024;
void addThreads(CLI::App& command, int& threads);

// The options --max-texture-pixels and --max-memory, of all commands that read images.
void addLimits(CLI::App& command);

// The scene's warnings, on stderr.
void printWarnings(const Scene& scene);

// Throws InputError if `file` can't be written; an empty name is none. Leaves what is there.
void checkWritableFile(const std::string& file);

// Throws InputError if two of the files, each with what it is, are one: what is read would be overwritten, or what was
// written. An empty name is none.
void checkDistinct(const std::vector<std::pair<const char*, std::string>>& files);

// Makes the folder where it is not there, with those above it, and throws InputError if that fails or
// if `file` can't be written into it. True if the folder is new.
bool prepareFolder(const std::filesystem::path& folder, const std::string& file);

}  // namespace h2mc
