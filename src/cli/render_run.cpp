// SPDX-License-Identifier: MIT
#include "cli/render_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>

#include "cli/commands.h"
#include "cli/identity.h"
#include "cli/image_header.h"
#include "cli/join_ranks.h"
#include "cli/progress_display.h"
#include "cli/statistics_table.h"
#include "cli/stop_signals.h"
#include "h2mc_version.h"
#include "mcmc/render/integrator_choice.h"
#include "mcmc/render/render_report.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"
#include "render/integrator/features.h"
#include "render/integrator/layers.h"
#include "render/scene/scene.h"
#include "render/scene/scene_reader.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

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
  std::vector<LayerKind> layers;
  FilmWindow window{};
  std::vector<Layer> features{};  // those of the layers that the integrator has nothing to do with
  std::uint64_t seed = 0;
  int threads = 1;
  std::string sceneDigest{};
  int ranks = 1;
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

bool isPng(const std::string& file) {
  return lowerCase(fs::path(file).extension().string()) == ".png";
}

// Options that have no effect are mistakes.
void checkEffects(const Outputs& outputs, const RenderOptions& options) {
  if (!options.layers.empty() && !isExr(outputs.image))
    throw InputError("--aov: layers are written into an EXR; \"" + outputs.image + "\" is none");
  if (options.look.given() && outputs.png.empty() && !isPng(outputs.image))
    throw InputError("--exposure and --tonemap are for a PNG: give --png");
}

void checkOutputs(const Outputs& outputs, const RenderOptions& options) {
  checkDistinct({{"the image that is rendered again", options.again.image},
                 {"the scene", options.scene},
                 {"the image", outputs.image},
                 {"the PNG", outputs.png},
                 {"--stats", options.statistics},
                 {"the checkpoint", checkpointFile(options.keep, outputs.image)}});
  checkWritable(outputs.image);
  if (!outputs.png.empty()) checkWritable(outputs.png);
  checkWritableFile(options.statistics);
  checkWritableFile(options.keep.checkpoint);
}

Scene readSceneFor(const RenderOptions& options, FilmWindow& window) {
  ReadOptions read = readOptionsOf(options.defines, options.permissive, options.confine);
  read.width = options.width;
  read.height = options.height;
  read.scale = options.scale;
  read.crop = options.crop;
  read.window = &window;
  return readScene(options.scene, read);
}

// What of the command line decides on the picture and is nowhere else in the header.
nlohmann::json requestOf(const RenderOptions& options) {
  nlohmann::json defines = nlohmann::json::object();
  for (const auto& [name, value] : parseDefines(options.defines)) defines[name] = value;
  nlohmann::json request{{"defines", defines}};
  const auto add = [&](const char* name, double value) {
    if (value > 0) request[name] = value;
  };
  add("width", options.width);
  add("height", options.height);
  add("scale", options.scale);
  add("seconds", options.budget.seconds);
  add("samplesPerPixel", static_cast<double>(options.budget.samplesPerPixel));
  add("mutationsPerPixel", static_cast<double>(options.budget.mutationsPerPixel));
  if (options.permissive) request["permissive"] = true;
  if (options.crop)
    request["crop"] = {options.crop->x, options.crop->y, options.crop->width, options.crop->height};
  if (!options.layers.empty()) {
    request["aov"] = options.layers;
    request["aovSamples"] = options.layerSamples;
  }
  return request;
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
  // What the scene's own words are in is not always UTF-8.
  header.request =
      requestOf(plan.options).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return header;
}

nlohmann::json statisticsOf(const Plan& plan, const RenderResult& result) {
  nlohmann::json all = renderReport(plan.integrator, plan.seed, plan.threads, result);
  all["programVersion"] = H2MC_VERSION_STRING;
  all["scene"] = plan.options.scene;
  all["image"] = plan.outputs.image;
  if (plan.ranks > 1) all["ranks"] = plan.ranks;
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
  const ToneMapping look = toneMapping(plan.options.look);
  const auto writePng = [&](const std::string& file) {
    writeImage(file, plan.options.look.given() ? toneMapped(result.image, look) : result.image);
  };
  if (isPng(plan.outputs.image)) return writePng(plan.outputs.image);
  const std::vector<Layer> layers = layersOf(plan.layers, plan.features, result);
  writeLayeredImage(plan.outputs.image, result.image,
                    {attributesOf(headerOf(plan, result)), layers, plan.window});
  if (!plan.outputs.png.empty()) writePng(plan.outputs.png);
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

// What the image that is rendered again was made from, if that is not what there is now.
void compareWithBefore(const RenderedBefore& before, const Plan& plan) {
  if (before.image.empty()) return;
  if (before.sceneDigest != plan.sceneDigest)
    spdlog::warn(
        "\"{}\" has changed since \"{}\" was rendered, or a file that it refers to (digest {}, now "
        "{}): the picture will be another",
        plan.options.scene, before.image, before.sceneDigest, plan.sceneDigest);
  if (before.programVersion != H2MC_VERSION_STRING)
    spdlog::warn("\"{}\" was rendered by version {}, this is {}: the picture may be another",
                 before.image, before.programVersion, H2MC_VERSION_STRING);
}

std::vector<Layer> featuresFor(const Plan& plan, const Scene& scene) {
  FeatureRequest request;
  request.layers = featuresAmong(plan.layers);
  request.samplesPerPixel = plan.options.layerSamples;
  request.seed = plan.seed;
  request.threads = plan.threads;
  request.stop = &StopSignals::requested();
  return renderFeatures(scene, request);
}

// For the page of --serve.
nlohmann::json factsOf(const Plan& plan) {
  return {{"scene", plan.options.scene},
          {"image", plan.outputs.image},
          {"integrator", plan.integrator.integrator()},
          {"options", optionText(plan.integrator)},
          {"seed", std::to_string(plan.seed)},
          {"threads", plan.threads},
          {"secondsGiven", plan.options.budget.seconds},
          {"programVersion", H2MC_VERSION_STRING}};
}

// What decides on the state of a render, besides what decides on the picture.
nlohmann::json withState(nlohmann::json identity, const Plan& plan) {
  std::string kept;
  const PixelStatistics statistics = statisticsFor(plan.layers);
  const auto keep = [&](bool wanted, LayerKind kind) {
    if (wanted) kept += (kept.empty() ? "" : ",") + std::string(layerName(kind).name);
  };
  keep(statistics.variance, LayerKind::kVariance);
  keep(statistics.counts, LayerKind::kMutations);
  identity["layers"] = kept.empty() ? "none" : kept;
  const std::optional<PixelRectangle>& crop = plan.options.crop;
  identity["crop"] =
      crop ? fmt::format("{},{},{},{}", crop->x, crop->y, crop->width, crop->height) : "none";
  return identity;
}

// Before a render by ranks: all of them see the same. Throws InputError, RankLost.
void checkAlike(Ranks& ranks, const nlohmann::json& identity, const Archive* resume) {
  const std::uint64_t left = resume ? resume->left() : 0;
  const std::string own = fmt::format("{} {} {}", H2MC_VERSION_STRING, left, identity.dump());
  const std::vector<std::string> all = ranks.gather(own);
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0])
      throw InputError(
          fmt::format("rank {} has another program, scene or checkpoint than rank 0", r));
}

// Of all ranks. Where one is lost: of this one.
double sumOf(Ranks& ranks, double own) {
  double sum = 0;
  try {
    for (const std::string& bytes :
         ranks.gather({reinterpret_cast<const char*>(&own), sizeof own})) {
      double one = 0;
      std::memcpy(&one, bytes.data(), sizeof one);
      sum += one;
    }
  } catch (const RankLost& e) {
    spdlog::error("{}: the image holds what there was by then", e.what());
    return own;
  }
  return sum;
}

int render(const RenderOptions& options, Ranks* ranks) {
  const bool first = !ranks || ranks->isFirst();
  if (options.quiet) spdlog::set_level(first ? spdlog::level::err : spdlog::level::off);
  checkBudget(options.budget);
  const Outputs outputs = outputsOf(options);
  checkIntegratorWish(options.integrator);
  toneMapping(options.look);  // throws where it means nothing
  const std::vector<LayerKind> layers = layerKinds(options.layers, "--aov");
  checkEffects(outputs, options);
  if (first) checkOutputs(outputs, options);
  if (ranks && (!options.live.display.empty() || options.live.serve))
    throw InputError("--serve and --display: a render by several processes can't be watched yet");
  LiveView live(options.live, outputs.image);

  FilmWindow window;
  const Scene scene = readSceneFor(options, window);
  if (!options.quiet) {
    printWarnings(scene);
    for (const std::string& note : scene.notes) fmt::print(stderr, "{}\n", note);
  }
  const IntegratorChoice choice = chooseIntegrator(options.integrator, scene);
  Plan plan{options, outputs, choice.options, layers, window};
  plan.seed = options.seed.value_or(scene.seed.value_or(0));
  plan.threads = options.threads > 0
                     ? options.threads
                     : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (ranks) plan.ranks = ranks->count();
  if (!options.quiet)
    fmt::print(stderr, "{}: {} x {}, {}, seed {}, {} thread{}{}\n", options.scene, scene.film.width,
               scene.film.height, plan.integrator.integrator(), plan.seed, plan.threads,
               plan.threads == 1 ? "" : "s",
               ranks ? fmt::format(" on each of {} ranks", plan.ranks) : "");
  if (!options.quiet && !live.address().empty())
    fmt::print(stderr, "to be watched at {}\n", live.address());

  const nlohmann::json identity = identityOf(
      scene, {parseDefines(options.defines), options.permissive}, plan.integrator, plan.seed);
  plan.sceneDigest = sceneDigest(identity, options.scene);
  if (first) compareWithBefore(options.again, plan);

  // Until the files are written, so that a second signal leaves no half of one.
  const StopSignals signals(ranks != nullptr);
  live.describe(factsOf(plan));
  if (first) plan.features = featuresFor(plan, scene);
  Keeper keeper(
      options.keep,
      Checkpoint(checkpointFile(options.keep, outputs.image), withState(identity, plan)),
      [&](const RenderResult& soFar) { tryToWriteImages(plan, soFar); }, ranks);
  RenderResult result;
  {
    ProgressDisplay display(
        options.quiet ? ProgressDisplay::Style::kNone : ProgressDisplay::styleOfStderr(),
        options.budget.seconds);
    RenderRequest request;
    request.budget = options.budget;
    request.seed = plan.seed;
    request.threads = plan.threads;
    request.stop = ranks ? &ranks->stop() : &StopSignals::requested();
    request.ranks = ranks;
    request.progress = [&](const RenderProgress& progress) {
      display.update(progress);
      live.progress(progress);
    };
    request.resume = keeper.resume();
    if (ranks) checkAlike(*ranks, identity, request.resume);
    request.pixelStatistics = statisticsFor(plan.layers);
    bool& variance = request.pixelStatistics.variance;
    variance = keeper.keepsVariance(live.wantsVariance() && !variance) || variance;
    if (options.keep.resume && first)
      for (const std::string& file : {outputs.image, checkpointFile(options.keep, outputs.image)})
        removeAbandoned(file);
    if (keeper.wanted() || live.wanted())
      request.watch = [&](RenderInProgress& render) {
        keeper.look(render);
        live.look(render);
      };
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
  if (ranks) result.cpuSeconds = sumOf(*ranks, result.cpuSeconds);
  if (!first) return result.interrupted ? kInterrupted : kSuccess;
  const int exitCode = write(plan, result);
  if (exitCode != kFailed) keeper.finish(result.interrupted);
  live.finish(result, exitCode != kFailed);
  return exitCode;
}

}  // namespace

int runRender(const RenderOptions& options) {
  const std::unique_ptr<Ranks> ranks = joinRanks();
  if (!ranks) return render(options, nullptr);
  return runOnRanks(*ranks, [&] {
    if (ranks->isFirst()) return render(options, ranks.get());
    RenderOptions quiet = options;
    quiet.quiet = true;
    return render(quiet, ranks.get());
  });
}

}  // namespace h2mc
