// SPDX-License-Identifier: MIT
// h2mc gradcheck
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "check/gradcheck/report.h"
#include "cli/commands.h"
#include "cli/progress_display.h"
#include "cli/stop_signals.h"
#include "h2mc_version.h"
#include "render/image/atomic_file.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/path_text.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

constexpr int kDefaultMaxDepth = 8;
constexpr std::size_t kNamed = 5;  // failures that the message names

struct GradcheckOptions {
  std::string scene, json, html, replay, confine;
  GradcheckSettings settings;
  std::optional<std::uint64_t> seed;
  std::optional<int> maxDepth;
  std::vector<std::string> defines;
  bool quiet = false, permissive = false;
};

// The scene's own longest path, as far as paths are usually looked at.
int depthOf(const Scene& scene) {
  const auto text = scene.options.find("maxDepth");
  int depth = text == scene.options.end() ? -1 : std::atoi(text->second.c_str());
  if (scene.integrator.has("maxDepth")) depth = scene.integrator.integer("maxDepth");
  return depth >= 1 ? std::min(depth, kDefaultMaxDepth) : kDefaultMaxDepth;
}

SampledPath parseReplay(const std::string& text) {
  SampledPath path;
  const std::string wrong = parsePathText(text, path.technique, path.sample);
  if (!wrong.empty()) throw InputError("--replay: " + wrong);
  return path;
}

void write(const GradcheckOptions& options, const nlohmann::json& report) {
  if (!options.json.empty()) writeTextAtomically(options.json, report.dump(2) + "\n");
  if (!options.html.empty()) writeTextAtomically(options.html, gradcheckPage(report));
}

// On stderr, what fails with what looks at it alone.
void printFailures(const GradcheckOptions& options, const GradcheckResult& result,
                   const GradcheckSettings& settings) {
  std::size_t named = 0;
  for (const PathCheck& p : result.paths) {
    if (!p.failed()) continue;
    if (named++ == kNamed) {
      fmt::print(stderr, "h2mc: ... and {} more\n",
                 result.failures() - static_cast<long long>(kNamed));
      break;
    }
    std::string what;
    if (p.verdict == ad::Verdict::kWrong)
      what = fmt::format("double AD: gradient {:.1e}, Hessian {:.1e}", p.gradientError,
                         p.hessianError);
    for (std::size_t k = 0; k < settings.forms.size(); ++k)
      if (p.forms[k].verdict == FormVerdict::kWrong)
        what += fmt::format("{}float, {} form: value {:.1e}, gradient {:.1e}, Hessian {:.1e}",
                            what.empty() ? "" : "; ", settings.forms[k].name, p.forms[k].value,
                            p.forms[k].gradient, p.forms[k].hessian);
    fmt::print(stderr,
               "h2mc: out of tolerance, {} (seed {}): {}\n"
               "  h2mc gradcheck {} --replay \"{}\"\n",
               nameOf(p.path), settings.seed, what, options.scene,
               pathText(p.path.technique, p.path.sample));
  }
}

int run(const GradcheckOptions& options) {
  if (options.quiet) spdlog::set_level(spdlog::level::err);
  std::optional<SampledPath> replay;
  if (!options.replay.empty()) replay = parseReplay(options.replay);
  checkDistinct({{"the scene", options.scene}, {"--json", options.json}, {"--html", options.html}});
  checkWritableFile(options.json);
  checkWritableFile(options.html);

  const Scene scene =
      readScene(options.scene, readOptionsOf(options.defines, options.permissive, options.confine));
  if (!options.quiet) printWarnings(scene);

  GradcheckSettings settings = options.settings;
  settings.seed = options.seed.value_or(scene.seed.value_or(0));
  settings.maxLength = options.maxDepth.value_or(depthOf(scene));

  // Until the files are written, so that a second signal leaves no half of one.
  const StopSignals signals;
  settings.stop = &StopSignals::requested();
  GradcheckResult result;
  if (replay) {
    settings.maxLength = std::max(settings.maxLength, replay->technique.length());
    result.paths.push_back(checkPath(scene, *replay, settings));
    if (!result.paths[0].traced)
      throw InputError("--replay: in this scene that path carries no light");
    if (!options.quiet) fmt::print("{}", describePath(scene, *replay, settings));
  } else {
    ProgressDisplay display(
        options.quiet ? ProgressDisplay::Style::kNone : ProgressDisplay::styleOfStderr(), 0);
    const double start = wallClock();
    settings.progress = [&](long long done, long long total) {
      const double elapsed = wallClock() - start;
      display.update({static_cast<double>(done) / static_cast<double>(total), elapsed,
                      static_cast<double>(done) / std::max(elapsed, 1e-9), "paths"});
    };
    result = gradcheck(scene, settings);
  }
  nlohmann::json report = gradcheckReport(scene, settings, result);
  report["programVersion"] = H2MC_VERSION_STRING;
  try {
    write(options, report);
  } catch (const std::exception& e) {
    // The paths were right before: a failure now is not the user's mistake.
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  if (!replay && !options.quiet) fmt::print("{}", gradcheckTable(report));
  printFailures(options, result, settings);
  if (result.interrupted) {
    fmt::print(stderr, "h2mc: interrupted after {} paths\n", result.paths.size());
    return kInterrupted;
  }
  if (result.paths.empty()) {
    fmt::print(stderr, "h2mc: no light arrives in this scene: there is no path to check\n");
    return kCheckFailed;
  }
  return result.failures() > 0 ? kCheckFailed : kSuccess;
}

}  // namespace

void addGradcheckCommand(CLI::App& app, Run& run_) {
  auto options = std::make_shared<GradcheckOptions>();
  CLI::App* command =
      app.add_subcommand("gradcheck", "Check a scene's derivatives against finite differences");
  GradcheckSettings& settings = options->settings;
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  const CLI::Validator positive = positiveNumber();
  auto* paths = command
                    ->add_option("-n,--paths", settings.paths,
                                 "Paths to check: half of them connections of bidirectional "
                                 "samples, half states of h2mc's chains")
                    ->check(positive)
                    ->capture_default_str();
  addSeed(*command, options->seed, "Same seed: same paths. Default: the scene's, or 0");
  command
      ->add_option("--tolerance", settings.tolerance,
                   "Relative error allowed to derivatives in double")
      ->check(positive)
      ->capture_default_str();
  command
      ->add_option("--float-tolerance", settings.floatTolerance,
                   "Relative error allowed to the float forms")
      ->check(positive)
      ->capture_default_str();
  command
      ->add_option("--max-depth", options->maxDepth,
                   "Longest path in edges. Default: the scene's, at most 8")
      ->check(CLI::Range(1, kMaxPathLength));
  addThreads(*command, settings.threads);
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  command->add_option("--json", options->json, "JSON file for everything that was found")
      ->type_name("FILE");
  command->add_option("--html", options->html, "Page with tables and plots")->type_name("FILE");
  command
      ->add_option("--replay", options->replay,
                   "Check one path alone, given as a failure's message or the JSON file has it: "
                   "\"s=.. t=.. u=.. choice=..\"")
      ->excludes(paths);
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but failures");
  command->footer(
      "Exit code 1 when a path is out of tolerance. Paths whose differences can't judge (a kink\n"
      "nearby, rounding noise) are counted and don't fail.\n"
      "\n"
      "Example:\n"
      "  h2mc gradcheck scene.xml --paths 10000 --html gradcheck.html");
  command->callback([options, &run_] { run_ = [options] { return run(*options); }; });
}

}  // namespace h2mc
