// SPDX-License-Identifier: MIT
// h2mc compare
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "cli/progress_display.h"
#include "cli/stop_signals.h"
#include "compare/external.h"
#include "compare/figure_file.h"
#include "compare/page.h"
#include "compare/paper.h"
#include "compare/reference.h"
#include "compare/rendered_reference.h"
#include "compare/runs.h"
#include "compare/tables.h"
#include "h2mc_version.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::vector<std::string> scenes;
  std::string integrators = "path,bdpt,mmlt,h2mc";
  std::string time, mutations;
  std::vector<std::string> externals;
  std::string embed = "last";
  bool quiet = false;
  ComparisonPlan plan;
};

// Which run of how many, and the time left for all.
class StatusLine {
 public:
  explicit StatusLine(bool quiet)
      : style_(quiet ? ProgressDisplay::Style::kNone : ProgressDisplay::styleOfStderr()) {}
  ~StatusLine() { clear(); }

  void show(const ComparisonStatus& status) {
    if (style_ == ProgressDisplay::Style::kNone) return;
    std::string line = status.what;
    if (status.total > 0)
      line += fmt::format("; {} left for all runs", duration(status.total - status.done));
    if (style_ == ProgressDisplay::Style::kBar) {
      fmt::print(stderr, "\r{:.{}}\033[K", line, 100);
      std::fflush(stderr);
      shown_ = true;
    } else if (status.what != last_ && status.total > 0) {
      fmt::print(stderr, "{}\n", line);
    }
    last_ = status.what;
  }
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }

 private:
  ProgressDisplay::Style style_;
  bool shown_ = false;
  std::string last_;
};

ComparisonPlan planOf(const CompareOptions& options) {
  ComparisonPlan plan = options.plan;
  plan.scenes = namedScenes(options.scenes);
  plan.methods = splitMethods(options.integrators);
  for (const std::string& external : options.externals) {
    plan.externals.push_back(parseExternal(external));
    for (std::size_t i = 0; i + 1 < plan.externals.size(); ++i)
      if (plan.externals[i].name == plan.externals.back().name)
        throw InputError("--external " + external + ": the name is there twice");
  }
  if (!options.time.empty() && !options.mutations.empty())
    throw InputError("--time and --mutations-per-pixel exclude one another: give one");
  plan.timed = options.mutations.empty();
  plan.marks = parseMarks(!plan.timed            ? options.mutations
                          : options.time.empty() ? std::string("60")
                                                 : options.time);
  if (!plan.timed)
    for (const double mark : plan.marks)
      if (mark != std::floor(mark))
        throw InputError("--mutations-per-pixel: expected whole numbers, got \"" +
                         options.mutations + "\"");
  if (plan.threads == 0)
    plan.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  plan.programVersion = H2MC_VERSION_STRING;
  return plan;
}

int interrupted(const ComparisonPlan& plan) {
  fmt::print(
      stderr,
      "h2mc: interrupted; what is finished is in \"{}\", and the same command goes on from there\n",
      plan.folder.string());
  return kInterrupted;
}

void writeAll(const ComparisonPlan& plan, const std::vector<SceneResults>& results,
              const std::vector<Image>& references, EmbeddedImages embedded) {
  const auto write = [&](const char* name, const std::string& text) {
    writeTextAtomically((plan.folder / name).string(), text);
  };
  write("results.csv", resultsCsv(results, plan));
  write("results.json", resultsJson(results, plan).dump(1) + "\n");
  write("errors.csv", errorsCsv(results));
  write("summary.csv", summaryCsv(results));
  if (!canDrawFigures())
    spdlog::warn("no figures: this build was made without cairo (libcairo2-dev, pkg-config)");
  const std::vector<PaperFile> paper = paperFiles(results, plan, references);
  std::filesystem::create_directories(plan.folder / "figures");
  for (const PaperFile& file : paper) write(file.name.c_str(), file.bytes);
  write("index.html", comparisonPage(results, plan, references, embedded));
}

int compare(const CompareOptions& options) {
  if (options.quiet) spdlog::set_level(spdlog::level::err);
  const ComparisonPlan plan = planOf(options);
  const ComparisonSetup setup = setUp(plan);
  if (!options.quiet)
    for (const auto& one : setup.scenes) printWarnings(one.scene);

  // All that can be wrong is found out before anything is rendered.
  std::vector<Reference> given;
  std::vector<std::vector<MethodRuns>> externals;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const Scene& scene = setup.scenes[s].scene;
    SceneRuns outline{plan.scenes[s], scene.film.width, scene.film.height, {}, {}};
    if (plan.reference != "auto")
      given.push_back(givenReference(plan, plan.scenes[s], outline.width, outline.height));
    else
      chooseIntegrator(referenceIntegrator(plan, plan.scenes[s]), scene);
    externals.emplace_back();
    for (const ExternalMethod& external : plan.externals)
      externals.back().push_back(readExternal(external, outline, plan.scenes.size() == 1));
  }
  prepareFolder(plan.folder, "results.csv");

  const StopSignals signals;
  StatusLine line(options.quiet);
  ComparisonObserver observer;
  observer.stop = &StopSignals::requested();
  observer.status = [&](const ComparisonStatus& status) { line.show(status); };
  observer.note = [&](const std::string& note) {
    line.clear();
    if (!options.quiet) fmt::print(stderr, "h2mc: {}\n", note);
  };

  std::vector<SceneRuns> runs;
  if (!renderRuns(plan, setup, observer, runs)) {
    line.clear();
    return interrupted(plan);
  }
  std::vector<SceneResults> results;
  std::vector<Image> references;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    Reference reference;
    if (plan.reference != "auto") {
      reference = given[s];
    } else if (!renderReference(plan, setup.scenes[s], runs[s], observer, reference)) {
      line.clear();
      return interrupted(plan);
    }
    runs[s].reference = reference.facts;
    for (MethodRuns& external : externals[s]) runs[s].methods.push_back(std::move(external));
    if (!measure(runs[s], reference.image, observer)) {
      line.clear();
      return interrupted(plan);
    }
    results.push_back(resultsOf(std::move(runs[s]), plan, reference.image));
    references.push_back(std::move(reference.image));
  }
  line.clear();
  // The folder could be written to before: a failure now is not the user's mistake.
  try {
    writeAll(plan, results, references,
             options.embed == "none"  ? EmbeddedImages::kNone
             : options.embed == "all" ? EmbeddedImages::kAll
                                      : EmbeddedImages::kLast);
  } catch (const std::exception& e) {
    fmt::print(stderr, "h2mc: {}\n", e.what());
    return kFailed;
  }
  fmt::print("{}", textTable(results, plan));
  if (!options.quiet)
    fmt::print(stderr, "{}: the page; tables, figures and LaTeX beside it\n",
               (plan.folder / "index.html").string());
  return kSuccess;
}

}  // namespace

void addCompareCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<CompareOptions>();
  ComparisonPlan& plan = options->plan;
  plan.reference = "auto";
  plan.threads = 0;
  CLI::App* command =
      app.add_subcommand("compare", "Compare integrators: run time against error, as a page");
  const CLI::Validator positive = CLI::PositiveNumber;
  command->add_option("SCENE", options->scenes, "Scene files (Mitsuba XML)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "-i,--integrators", options->integrators,
          "NAME[:option=value,...] with commas between; `h2mc list integrators` shows them")
      ->type_name("INTEGRATOR")
      ->capture_default_str();
  command->add_option("-t,--time", options->time,
                      "Seconds of each run, or those at which its image is kept: 5,10,20,40 "
                      "(default: 60)");
  command->add_option("-m,--mutations-per-pixel", options->mutations,
                      "The same in mutations (path, bdpt: samples) a pixel instead of seconds");
  command->add_option("-k,--repeats", plan.repeats, "Independent runs of each integrator")
      ->check(positive)
      ->capture_default_str();
  command
      ->add_option("-r,--reference", plan.reference,
                   "Image to compare with ({scene}: the scene's name), or auto: rendered until its "
                   "error is a tenth of the smallest compared")
      ->type_name("FILE")
      ->capture_default_str();
  command
      ->add_option("--reference-integrator", plan.referenceIntegrator,
                   "For auto. Default: what the scene's README says, else bdpt")
      ->type_name("INTEGRATOR");
  command
      ->add_option("--reference-time", plan.referenceSeconds,
                   "For auto: seconds at most for each scene (default: 40 times the last mark)")
      ->check(positive);
  command
      ->add_option("--external", options->externals,
                   "name=FOLDER with another program's EXR images; repeatable")
      ->allow_extra_args(false);
  command->add_option("-o,--output", plan.folder, "Folder for everything; made if need be")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--embed", options->embed,
                   "Which images of the first repeats the page holds: last marks', all or none")
      ->capture_default_str()
      ->check(CLI::IsMember({"last", "all", "none"}));
  auto* width = command->add_option("--width", plan.width, "Width in pixels instead of the scenes'")
                    ->check(positive);
  auto* height =
      command->add_option("--height", plan.height, "Height in pixels instead of the scenes'")
          ->check(positive);
  command->add_option("--scale", plan.scale, "Factor on the scenes' width and height")
      ->check(positive)
      ->excludes(width)
      ->excludes(height);
  addSeed(*command, plan.seed, "Of the first repeat; the others follow");
  addThreads(*command, plan.threads);
  addDefines(*command, plan.defines);
  addLimits(*command);
  addPermissive(*command, plan.permissive);
  addConfine(*command, plan.confine);
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but the table and errors");
  command->footer(
      "Runs come one after the other, each on all threads. Interrupted by Ctrl-C, the same "
      "command\n"
      "goes on where it stopped; finished runs are not repeated. The folder holds index.html "
      "(open\n"
      "it in a browser), results.csv, errors.csv, summary.csv, results.json, paper.tex with a "
      "table\n"
      "and figures (SVG and PDF, under figures), and all images under runs.\n"
      "\n"
      "External images: FOLDER/SCENE/*.exr, or FOLDER/*SCENE*.exr; their time is the attribute\n"
      "wallSeconds or stands in the name: ring-2.5s-a.exr.\n"
      "\n"
      "Example:\n"
      "  h2mc compare ring.xml torus.xml -i mmlt,h2mc,h2mc:sigma=0.02 --time 5,10,20,40 -o "
      "results");
  command->callback([options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace h2mc
