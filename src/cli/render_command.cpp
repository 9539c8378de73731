// SPDX-License-Identifier: MIT
// h2mc render
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "cli/commands.h"
#include "cli/identity.h"
#include "cli/image_header.h"
#include "cli/keeper.h"
#include "cli/progress_display.h"
#include "cli/statistics_table.h"
#include "cli/stop_signals.h"
#include "h2mc_version.h"
#include "mcmc/render/integrator_choice.h"
#include "mcmc/render/render_report.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/scene/scene.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string scene, output, integrator, statistics, confine;
  RenderBudget budget;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  int width = 0, height = 0;
  double scale = 0;
  std::vector<std::string> defines;
  KeepOptions keep;
  bool permissive = false;
  bool quiet = false, png = false;
};

void checkBudget(const RenderBudget& budget) {
  const int given =
      (budget.seconds > 0) + (budget.samplesPerPixel > 0) + (budget.mutationsPerPixel > 0);
  if (given > 1)
    throw InputError(
        "--time, --samples-per-pixel and --mutations-per-pixel exclude one another: give one");
}

// The image, and the PNG beside it where that is another file.
struct Outputs {
  std::string image, png;
};

// What is rendered, once the scene has been asked as well.
struct Plan {
  const RenderOptions& options;
  Outputs outputs;
  OptionSet integrator;
  std::uint64_t seed = 0;
  int threads = 1;
  std::string sceneDigest{};
};

Outputs outputsOf(const RenderOptions& options) {
  Outputs outputs;
  outputs.image =
      options.output.empty() ? fs::path(options.scene).stem().string() + ".exr" : options.output;
  if (options.png) {
    const std::string png = fs::path(outputs.image).replace_extension(".png").string();
    if (png != outputs.image) outputs.png = png;
  }
  return outputs;
}

void checkOutputs(const Outputs& outputs, const RenderOptions& options) {
  checkDistinct({{"the scene", options.scene},
                 {"the image", outputs.image},
                 {"the PNG", outputs.png},
                 {"--stats", options.statistics},
                 {"the checkpoint", checkpointFile(options.keep, outputs.image)}});
  checkWritable(outputs.image);
  if (!outputs.png.empty()) checkWritable(outputs.png);
  checkWritableFile(options.statistics);
  checkWritableFile(options.keep.checkpoint);
}

Scene readSceneFor(const RenderOptions& options) {
  const std::vector<IntegratorPlugin> integrators = integratorPlugins();
  ReadOptions read;
  read.defines = parseDefines(options.defines);
  read.strictness = strictnessOf(options.permissive);
  read.integrators = integrators;
  read.confine = options.confine;
  read.width = options.width;
  read.height = options.height;
  read.scale = options.scale;
  return readScene(options.scene, read);
}

ImageHeader headerOf(const Plan& plan, const RenderResult& result) {
  ImageHeader header;
  header.scene = plan.options.scene;
  for (const std::string& define : plan.options.defines)
    header.sceneDefines += (header.sceneDefines.empty() ? "" : " ") + define;
  header.sceneDigest = plan.sceneDigest;
  header.integrator = plan.integrator.integrator();
  header.integratorOptions = optionText(plan.integrator);
  header.seeds = {plan.seed};
  header.threads = plan.threads;
  header.wallSeconds = result.wallSeconds;
  header.cpuSeconds = result.cpuSeconds;
  header.samples = static_cast<double>(result.samples);
  header.sampleUnit = result.sampleUnit;
  header.meanLuminance = result.meanLuminance;
  header.meanLuminanceError = result.meanLuminanceError;
  header.interrupted = result.interrupted;
  header.programVersion = H2MC_VERSION_STRING;
  return header;
}

nlohmann::json statisticsOf(const Plan& plan, const RenderResult& result) {
  nlohmann::json all = renderReport(plan.integrator, plan.seed, plan.threads, result);
  all["programVersion"] = H2MC_VERSION_STRING;
  all["scene"] = plan.options.scene;
  all["image"] = plan.outputs.image;
  return all;
}

void printSummary(const Outputs& outputs, const RenderResult& result) {
  const double seconds = std::max(result.wallSeconds, 1e-9);
  fmt::print(stderr, "{}{}: {} x {}, {} {} in {} ({} CPU), {} {}/s\n", outputs.image,
             result.interrupted ? " (interrupted)" : "", result.image.width, result.image.height,
             withSeparators(result.samples), result.sampleUnit, duration(result.wallSeconds),
             duration(result.cpuSeconds), withPrefix(static_cast<double>(result.samples) / seconds),
             result.sampleUnit);
  fmt::print(stderr, "mean luminance {:.6g} +- {:.2g}\n", result.meanLuminance,
             result.meanLuminanceError);
  if (!result.statistics.is_object()) return;
  nlohmann::json details = result.statistics;
  for (const char* said : {"mean luminance", "mean luminance standard error"}) details.erase(said);
  fmt::print(stderr, "{}", statisticsTable(details));
}

void writeImages(const Plan& plan, const RenderResult& result) {
  writeImage(plan.outputs.image, result.image, attributesOf(headerOf(plan, result)));
  if (!plan.outputs.png.empty()) writeImage(plan.outputs.png, result.image);
}

// An image on the way, which is replaced later: that it can't be written is no reason to stop.
void tryToWriteImages(const Plan& plan, const RenderResult& result) {
  try {
    writeImages(plan, result);
  } catch (const std::exception& e) {
    spdlog::warn("{}", e.what());
  }
}

int write(const Plan& plan, const RenderResult& result) {
  // The paths were right before the render: a failure now is not the user's mistake.
  try {
    writeImages(plan, result);
    if (!plan.options.statistics.empty())
      writeTextAtomically(plan.options.statistics, statisticsOf(plan, result).dump(2) + "\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  if (!plan.options.quiet) printSummary(plan.outputs, result);
  return result.interrupted ? kInterrupted : kSuccess;
}

int render(const RenderOptions& options) {
  if (options.quiet) spdlog::set_level(spdlog::level::err);
  checkBudget(options.budget);
  const Outputs outputs = outputsOf(options);
  checkIntegratorWish(options.integrator);
  checkOutputs(outputs, options);

  const Scene scene = readSceneFor(options);
  if (!options.quiet) {
    printWarnings(scene);
    for (const std::string& note : scene.notes) fmt::print(stderr, "{}\n", note);
  }
  const IntegratorChoice choice = chooseIntegrator(options.integrator, scene);
  Plan plan{options, outputs, choice.options};
  plan.seed = options.seed.value_or(scene.seed.value_or(0));
  plan.threads = options.threads > 0
                     ? options.threads
                     : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (!options.quiet)
    fmt::print(stderr, "{}: {} x {}, {}, seed {}, {} thread{}\n", options.scene, scene.film.width,
               scene.film.height, plan.integrator.integrator(), plan.seed, plan.threads,
               plan.threads == 1 ? "" : "s");

  const nlohmann::json identity = identityOf(
      scene, {parseDefines(options.defines), options.permissive}, plan.integrator, plan.seed);
  plan.sceneDigest = sceneDigest(identity, options.scene);

  // Until the files are written, so that a second signal leaves no half of one.
  const StopSignals signals;
  Keeper keeper(options.keep, Checkpoint(checkpointFile(options.keep, outputs.image), identity),
                [&](const RenderResult& soFar) { tryToWriteImages(plan, soFar); });
  RenderResult result;
  {
    ProgressDisplay display(
        options.quiet ? ProgressDisplay::Style::kNone : ProgressDisplay::styleOfStderr(),
        options.budget.seconds);
    RenderRequest request;
    request.budget = options.budget;
    request.seed = plan.seed;
    request.threads = plan.threads;
    request.stop = &StopSignals::requested();
    request.progress = [&](const RenderProgress& progress) { display.update(progress); };
    request.resume = keeper.resume();
    if (options.keep.resume)
      for (const std::string& file : {outputs.image, checkpointFile(options.keep, outputs.image)})
        removeAbandoned(file);
    if (keeper.wanted()) request.watch = [&](RenderInProgress& render) { keeper.look(render); };
    try {
      result = choice.integrator->render(scene, request);
    } catch (const ArchiveError& e) {
      throw InputError("cannot go on from \"" + checkpointFile(options.keep, outputs.image) +
                       "\": " + e.what());
    } catch (const FilmError& e) {
      throw std::runtime_error(
          fmt::format("\"{}\" by {}: {}", options.scene, plan.integrator.integrator(), e.what()));
    }
  }
  const int exitCode = write(plan, result);
  if (exitCode != kFailed) keeper.finish(result.interrupted);
  return exitCode;
}

}  // namespace

void addRenderCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a scene");
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--output", options->output,
                   "Image to write: .exr (32-bit float), .hdr or .png; default: the scene's name "
                   "with .exr, in the current folder")
      ->type_name("FILE");
  command->add_flag("--png", options->png, "Write a PNG (sRGB) beside the image as well");
  command
      ->add_option("-i,--integrator", options->integrator,
                   "NAME[:option=value,...]; `h2mc list integrators` shows them. Default: what "
                   "the scene says, else h2mc")
      ->type_name("INTEGRATOR");

  const CLI::Validator positive(
      [](std::string& text) -> std::string {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool number = !text.empty() && *end == '\0' && std::isfinite(value) && value > 0;
        return number ? "" : "expected a number above 0, got \"" + text + "\"";
      },
      "");
  auto* budget = command->add_option_group("Budget", "One of them; default: the integrator's own");
  budget->add_option("-t,--time", options->budget.seconds, "Seconds to render for")
      ->check(positive);
  budget->add_option("-s,--samples-per-pixel", options->budget.samplesPerPixel, "Samples a pixel")
      ->check(positive);
  budget
      ->add_option("-m,--mutations-per-pixel", options->budget.mutationsPerPixel,
                   "Mutations a pixel")
      ->check(positive);

  auto* width =
      command->add_option("--width", options->width, "Width in pixels instead of the scene's")
          ->check(positive);
  auto* height =
      command->add_option("--height", options->height, "Height in pixels instead of the scene's")
          ->check(positive);
  command->add_option("--scale", options->scale, "Factor on the scene's width and height")
      ->check(positive)
      ->excludes(width)
      ->excludes(height);
  addSeed(*command, options->seed,
          "Same scene, options and seed: same image. Default: the scene's, or 0");
  addThreads(*command, options->threads);
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  addKeepOptions(*command, options->keep);
  command->add_option("--stats", options->statistics, "JSON file to write the statistics to")
      ->type_name("FILE");
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but errors");
  command->footer(
      "Ctrl-C ends the render, writes the image of what was done so far and exits with code 130.\n"
      "--resume goes on from the checkpoint that is left then, or by a power cut.\n"
      "\n"
      "Examples:\n"
      "  h2mc render scene.xml -o scene.exr --png --time 60\n"
      "  h2mc render scene.xml -i mmlt:maxDepth=8 --mutations-per-pixel 256 -D width=512");
  command->callback([options, &run] { run = [options] { return render(*options); }; });
}

}  // namespace h2mc
