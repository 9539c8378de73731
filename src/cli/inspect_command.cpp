// SPDX-License-Identifier: MIT
// h2mc inspect
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/stop_signals.h"
#include "h2mc_version.h"
#include "inspect/picture.h"
#include "inspect/report.h"
#include "mcmc/methods/methods.h"
#include "mcmc/methods/presets.h"
#include "mcmc/render/integrator_choice.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/path/path_text.h"
#include "render/scene/scene_reader.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

struct InspectOptions {
  std::string scene, pixel, output, json, integrator, path = "ridge", replay, confine;
  std::vector<std::string> defines;
  std::optional<std::uint64_t> seed;
  InspectSettings settings;
  bool quiet = false, permissive = false;
};

// "X,Y", whole numbers.
std::pair<int, int> parsePixel(const std::string& text) {
  int x = 0, y = 0, read = 0;
  if (text.size() > 20 || std::sscanf(text.c_str(), "%d,%d%n", &x, &y, &read) != 2 ||
      static_cast<std::size_t>(read) != text.size())
    throw InputError("--pixel: expected X,Y in whole pixels, got \"" + text + "\"");
  return {x, y};
}

// The name before the options; without one the scene's options go to h2mc.
std::string methodWish(const std::string& wish) {
  return wish.empty() || wish[0] == ':' ? "h2mc" + wish : wish;
}

const MetropolisMethod& methodOf(const std::string& wish) {
  std::string name = wish.substr(0, wish.find(':'));
  if (const Preset* preset = presetNamed(name)) name = preset->method;
  Names names;
  for (const MetropolisMethod& method : metropolisMethods()) {
    if (method.name == name) return method;
    names.emplace_back(method.name);
  }
  throw InputError("--integrator: " + name + " makes no mutations that could be looked at; " +
                   suggestion(name, names));
}

int write(const fs::path& folder, const InspectOptions& options, const Scene& scene,
          const OptionSet& method, const InspectSettings& settings, const Inspection& inspection) {
  const auto json = [&](ArrayForm form) {
    nlohmann::json report = inspectionJson(scene, inspection, method, settings, form);
    report["programVersion"] = H2MC_VERSION_STRING;
    return report;
  };
  // The folder could be written to before: a failure now is not the user's mistake.
  try {
    writeTextAtomically((folder / "index.html").string(), inspectionPage(json(ArrayForm::kBase64)));
    const InspectedPair& pair = inspection.pairs.front();
    writeImage((folder / "wide.png").string(), drawPair(scene, inspection, pair, pair.wide));
    writeImage((folder / "close.png").string(), drawPair(scene, inspection, pair, pair.close));
    if (!options.json.empty())
      writeTextAtomically(options.json, json(ArrayForm::kNumbers).dump(1) + "\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  return kSuccess;
}

int run(const InspectOptions& options) {
  if (options.quiet) spdlog::set_level(spdlog::level::err);
  // What is wrong with the command line is said before a scene is read.
  InspectSettings settings = options.settings;
  settings.choice = options.path == "largest" ? PathChoice::kLargest
                    : options.path == "chain" ? PathChoice::kChain
                                              : PathChoice::kRidge;
  if (!options.replay.empty()) {
    settings.choice = PathChoice::kGiven;
    const std::string wrong = parsePathText(options.replay, settings.given, settings.givenSample);
    if (!wrong.empty()) throw InputError("--replay: " + wrong);
  } else if (options.pixel.empty()) {
    throw InputError("which pixel? --pixel X,Y, or a path by --replay");
  } else {
    std::tie(settings.pixelX, settings.pixelY) = parsePixel(options.pixel);
  }
  if (!settings.pair.empty()) checkPairText(settings.pair);
  const std::string wish = methodWish(options.integrator);
  checkIntegratorWish(wish);  // says what there is
  const MetropolisMethod& method = methodOf(wish);

  const Scene scene =
      readScene(options.scene, readOptionsOf(options.defines, options.permissive, options.confine));
  if (!options.quiet) printWarnings(scene);
  const OptionSet methodOptions = chooseIntegrator(wish, scene).options;
  if (settings.choice != PathChoice::kGiven &&
      !(settings.pixelX >= 0 && settings.pixelX < scene.film.width && settings.pixelY >= 0 &&
        settings.pixelY < scene.film.height))
    throw InputError(fmt::format("--pixel {}: the film has {} x {} pixels, from 0,0 to {},{}",
                                 options.pixel, scene.film.width, scene.film.height,
                                 scene.film.width - 1, scene.film.height - 1));
  settings.seed = options.seed.value_or(scene.seed.value_or(0));

  const fs::path folder = options.output.empty()
                              ? fs::path(options.scene).stem().string() + "-inspect"
                              : options.output;
  checkDistinct({{"the scene", options.scene}, {"--json", options.json}});
  checkWritableFile(options.json);
  const bool made = prepareFolder(folder, "index.html");
  // A folder that nothing was written to shall not stay; anybody's files keep it.
  const auto leave = [&](int code) {
    std::error_code ignored;
    if (made) fs::remove(folder, ignored);
    return code;
  };

  const StopSignals signals;
  settings.stop = &StopSignals::requested();
  std::optional<Inspection> inspection;
  try {
    inspection = inspect(scene, method, methodOptions, settings);
  } catch (const DarkPixel& e) {
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return leave(kCheckFailed);
  } catch (...) {
    leave(kFailed);
    throw;
  }
  if (inspection->interrupted) {
    fmt::print(stderr, "h2mc: interrupted; nothing was written\n");
    return leave(kInterrupted);
  }
  const int code = write(folder, options, scene, methodOptions, settings, *inspection);
  if (code != kSuccess) return code;
  if (!options.quiet) {
    fmt::print("{}", inspectionTable(scene, *inspection, methodOptions));
    fmt::print(stderr, "{}: the page; wide.png and close.png beside it\n",
               (folder / "index.html").string());
  }
  return kSuccess;
}

}  // namespace

void addInspectCommand(CLI::App& app, Run& run_) {
  auto options = std::make_shared<InspectOptions>();
  InspectSettings& settings = options->settings;
  CLI::App* command = app.add_subcommand(
      "inspect", "Show one path of a pixel: the target around it, its Hessian, what mutations do");
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  auto* pixel = command->add_option("--pixel", options->pixel,
                                    "X,Y from the film's upper left corner, which is 0,0");
  command
      ->add_option("-o,--output", options->output,
                   "Folder for index.html, wide.png and close.png; default: the scene's name "
                   "with -inspect, here")
      ->type_name("DIR");
  command
      ->add_option("--path", options->path,
                   "Which of the pixel's paths: of 32 that are drawn in proportion to the target, "
                   "the one with the clearest ridge; a state of a chain; or the one with the "
                   "largest target that was met")
      ->check(CLI::IsMember({"ridge", "chain", "largest"}))
      ->capture_default_str();
  command
      ->add_option("--replay", options->replay,
                   "A path as inspect and gradcheck print it: \"s=.. t=.. u=.. choice=..\"")
      ->excludes(pixel);
  command->add_option("--pair", settings.pair,
                      "What is drawn first: eigenvectors e1,e2 by the size of their eigenvalues, "
                      "or coordinates u0,u1. Default: e1,e2, or u0,u1 without derivatives");
  command
      ->add_option("--slice-size", settings.sliceSize,
                   "Edge of the wide slices, in primary coordinates. Default: what shows "
                   "the ridge; 8 sigma with another --path and with --replay")
      ->check(CLI::Range(1e-6, 1.0));
  command
      ->add_option("--resolution", settings.resolution,
                   "Cells along a slice's edge; odd ones have the path in the middle of one")
      ->check(CLI::Range(9, 257))
      ->capture_default_str();
  command->add_option("--proposals", settings.proposals, "Proposals of each mutation")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("-i,--integrator", options->integrator,
                   "h2mc or mmlt, with options as in h2mc:sigma=0.02,minDepth=4. Default: h2mc "
                   "with the scene's options")
      ->type_name("INTEGRATOR");
  addSeed(*command, options->seed, "Same seed: same path. Default: the scene's, or 0");
  addThreads(*command, settings.threads);
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  command
      ->add_option("--json", options->json,
                   "JSON file: path, eigenvectors, proposals, and the chosen pair's slices")
      ->type_name("FILE");
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but failures");
  command->footer(
      "Exit code 1 when no light arrives at the pixel.\n"
      "\n"
      "Example:\n"
      "  h2mc inspect scene.xml --pixel 250,180 -i h2mc:minDepth=4 -o inspect");
  command->callback([options, &run_] { run_ = [options] { return run(*options); }; });
}

}  // namespace h2mc
