// SPDX-License-Identifier: MIT
// h2mc stress
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "check/gradcheck/report.h"
#include "check/stress/report.h"
#include "cli/commands.h"
#include "cli/progress_display.h"
#include "cli/stop_signals.h"
#include "h2mc_version.h"
#include "render/image/atomic_file.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/path_text.h"

namespace h2mc {
namespace {

constexpr int kDefaultMaxDepth = 8;
constexpr int kDefaultWidth = 48;

struct StressOptions {
  std::string scene, json, replay, confine;
  StressSettings settings;
  std::optional<std::uint64_t> seed;
  int maxDepth = kDefaultMaxDepth, width = kDefaultWidth;
  std::vector<std::string> only, defines;
  bool quiet = false, permissive = false;
};

// A path of the one variation that was asked for, in full.
int replayPath(const StressOptions& options, const ReadOptions& read, const Variation& variation) {
  SampledPath path;
  const std::string wrong = parsePathText(options.replay, path.technique, path.sample);
  if (!wrong.empty()) throw InputError("--replay: " + wrong);
  StressSettings settings = options.settings;
  const std::optional<Scene> scene = makeVariation(options.scene, read, variation, settings);
  if (!scene) throw InputError("--only " + variation.name + ": that changes nothing in this scene");
  GradcheckSettings gradcheck;
  gradcheck.maxLength = path.technique.length();
  fmt::print("{}", describePath(*scene, path, gradcheck));
  return kSuccess;
}

std::vector<const Variation*> chosenVariations(const StressOptions& options) {
  try {
    return chooseVariations(options.only);
  } catch (const std::invalid_argument& e) {
    throw InputError(std::string("--only: ") + e.what());
  }
}

int run(const StressOptions& options) {
  spdlog::set_level(spdlog::level::err);  // that a variation is dark is in the table
  const std::vector<const Variation*> variations = chosenVariations(options);
  if (!options.replay.empty() && variations.size() != 1)
    throw InputError("--replay: which variation's path is it? Name one with --only");
  checkDistinct({{"the scene", options.scene}, {"--json", options.json}});
  checkWritableFile(options.json);
  ReadOptions read = readOptionsOf(options.defines, options.permissive, options.confine);
  read.width = options.width;
  if (!options.replay.empty()) return replayPath(options, read, *variations[0]);

  StressSettings settings = options.settings;
  {
    // What is wrong with the scene itself is the user's business.
    const Scene scene = readScene(options.scene, read);
    if (!options.quiet) printWarnings(scene);
    settings.seed = options.seed.value_or(scene.seed.value_or(0));
  }
  settings.maxLength = options.maxDepth;

  const StopSignals signals;
  settings.stop = &StopSignals::requested();
  std::vector<VariationOutcome> outcomes;
  bool interrupted = false;
  {
    ProgressDisplay display(
        options.quiet ? ProgressDisplay::Style::kNone : ProgressDisplay::styleOfStderr(), 0);
    const double start = wallClock();
    for (const Variation* variation : variations) {
      VariationOutcome outcome = runVariation(options.scene, read, *variation, settings);
      interrupted = settings.stop->load();
      if (interrupted) break;  // half of one says nothing
      outcomes.push_back(std::move(outcome));
      const double elapsed = wallClock() - start, done = static_cast<double>(outcomes.size());
      display.update({done / static_cast<double>(variations.size()), elapsed,
                      done / std::max(elapsed, 1e-9), "variations"});
    }
  }
  std::string command = "h2mc stress " + options.scene;
  for (const std::string& define : options.defines) command += " -D " + define;
  // The film's height, and with it where paths begin, is rounded by the width.
  if (options.width != kDefaultWidth) command += fmt::format(" --width {}", options.width);
  nlohmann::json report = stressReport(settings, outcomes, command);
  report["programVersion"] = H2MC_VERSION_STRING;
  report["scene"] = options.scene;
  if (!options.json.empty()) {
    try {
      writeTextAtomically(options.json, report.dump(2) + "\n");
    } catch (const std::exception& e) {
      fmt::print(stderr, "h2mc: {}\n", e.what());
      return kFailed;
    }
  }
  if (!options.quiet) fmt::print("{}", stressTable(report));
  fmt::print(stderr, "{}", stressFailures(outcomes, command));
  if (interrupted) {
    fmt::print(stderr, "h2mc: interrupted after {} of {} variations\n", outcomes.size(),
               variations.size());
    return kInterrupted;
  }
  if (report["variations"].empty())
    throw InputError("--only: none of these variations changes anything in this scene");
  if (variations[0]->name == "as-is" && outcomes[0].error.empty() &&
      outcomes[0].findings.paths == 0) {
    fmt::print(stderr, "h2mc: no light arrives in this scene: there is nothing to stress\n");
    return kCheckFailed;
  }
  return report["failed"] > 0 ? kCheckFailed : kSuccess;
}

std::string footer() {
  std::string text = "Variations:\n";
  for (const Variation& v : stressVariations())
    text += fmt::format("  {:<16}{}\n", v.name, v.description);
  return text +
         "\n"
         "Exit code 1 when a contribution or a pixel is not finite, or when h2mc's pictures are "
         "not\n"
         "bdpt's. Each variation takes some seconds.\n"
         "\n"
         "Example:\n"
         "  h2mc stress scene.xml --only alpha,scale=1e6 --json stress.json";
}

}  // namespace

void addStressCommand(CLI::App& app, Run& run_) {
  auto options = std::make_shared<StressOptions>();
  CLI::App* command = app.add_subcommand(
      "stress", "Vary a scene to where numbers are hard, and see what becomes of it");
  StressSettings& settings = options->settings;
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  const CLI::Validator positive = CLI::Range(1LL, 1000000000000LL);
  auto* paths = command
                    ->add_option("-n,--paths", settings.paths,
                                 "Paths of each variation to look at: half of them connections of "
                                 "bidirectional samples, half states of h2mc's chains")
                    ->check(CLI::Range(1, 10000000))
                    ->capture_default_str();
  command
      ->add_option("--samples", settings.samples,
                   "Samples of bdpt and mutations of h2mc for the pictures of each variation; 0: "
                   "none are made")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--width", options->width, "Width of these pictures in pixels")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  addSeed(*command, options->seed, "Same seed: same findings. Default: the scene's, or 0");
  command->add_option("--max-depth", options->maxDepth, "Longest path in edges")
      ->check(CLI::Range(1, kMaxPathLength))
      ->capture_default_str();
  addThreads(*command, settings.threads);
  command
      ->add_option("--only", options->only,
                   "NAME,...: these variations alone; \"alpha\" stands for all alpha=..")
      ->delimiter(',');
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  command->add_option("--json", options->json, "JSON file for everything that was found")
      ->type_name("FILE");
  command
      ->add_option("--replay", options->replay,
                   "Print one path of the variation that --only names, given as a message or the "
                   "JSON file has it: \"s=.. t=.. u=.. choice=..\"")
      ->excludes(paths);
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but failures");
  command->footer(footer());
  command->callback([options, &run_] { run_ = [options] { return run(*options); }; });
}

}  // namespace h2mc
