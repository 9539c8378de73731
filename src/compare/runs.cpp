// SPDX-License-Identifier: MIT
#include "compare/runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/record_file.h"
#include "render/core/index.h"
#include "render/image/atomic_file.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// One run as the plan has it.
struct Job {
  std::size_t scene, method;
  int repeat;
};

std::vector<Job> jobsOf(const ComparisonPlan& plan) {
  std::vector<Job> jobs;
  const std::size_t methods = plan.methods.size();
  for (int repeat = 0; repeat < plan.repeats; ++repeat)
    for (std::size_t scene = 0; scene < plan.scenes.size(); ++scene)
      for (std::size_t i = 0; i < methods; ++i)
        jobs.push_back({scene, (i + static_cast<std::size_t>(repeat) + scene) % methods, repeat});
  return jobs;
}

json recordOf(const Repeat& run, const json& key) {
  json points = json::array();
  for (const Point& p : run.points)
    points.push_back({{"mark", p.mark},
                      {"seconds", p.seconds},
                      {"cpuSeconds", p.cpuSeconds},
                      {"samples", p.samples},
                      {"perPixel", p.perPixel},
                      {"sampleUnit", p.sampleUnit},
                      {"image", p.image.filename().string()},
                      {"statistics", p.statistics}});
  return {{"key", key}, {"seed", run.seed}, {"points", points}};
}

// The finished run in this folder, if it is the one that is looked for.
bool readRecord(const fs::path& folder, const json& key, Repeat& run) {
  const json record = readRecordFile(folder);
  if (!record.is_object() || record.value("key", json()) != key) return false;
  run.seed = record["seed"];
  for (const json& p : record["points"]) {
    Point point;
    point.mark = p["mark"];
    point.seconds = p["seconds"];
    point.cpuSeconds = p["cpuSeconds"];
    point.samples = p["samples"];
    point.perPixel = p["perPixel"];
    point.sampleUnit = p["sampleUnit"];
    point.image = folder / p["image"].get<std::string>();
    point.statistics = p["statistics"];
    if (!fs::exists(point.image)) return false;
    run.points.push_back(std::move(point));
  }
  return true;
}

class Runner {
 public:
  Runner(const ComparisonPlan& plan, const ComparisonSetup& setup,
         const ComparisonObserver& observer)
      : plan_(plan), setup_(setup), observer_(observer) {}

  // False: stopped.
  bool run(std::vector<SceneRuns>& results) {
    const std::vector<Job> jobs = jobsOf(plan_);
    std::vector<Repeat> runs(jobs.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < jobs.size(); ++i)
      if (!readRecord(folderOf(jobs[i]), keyOf(jobs[i]), runs[i])) missing.push_back(i);
    if (missing.size() < jobs.size() && observer_.note)
      observer_.note(fmt::format("{} of {} runs are there already", jobs.size() - missing.size(),
                                 jobs.size()));
    for (std::size_t k = 0; k < missing.size(); ++k) {
      const Job& job = jobs[missing[k]];
      status_.what =
          fmt::format("run {} of {}: {}, {}, repeat {}", missing[k] + 1, jobs.size(),
                      plan_.scenes[job.scene].name, plan_.methods[job.method], job.repeat + 1);
      remaining_ = missing.size() - k;
      if (!render(job, runs[missing[k]])) return false;
    }
    collect(jobs, runs, results);
    return true;
  }

 private:
  json keyOf(const Job& job) const {
    const ComparisonSetup::OneScene& scene = setup_.scenes[job.scene];
    json key = runKey(plan_, scene, scene.methods[job.method].options);
    key["seed"] = seedOf(job);
    key["marks"] = plan_.marks;
    key["timed"] = plan_.timed;
    return key;
  }
  std::uint64_t seedOf(const Job& job) const {
    return plan_.seed + static_cast<std::uint64_t>(job.repeat);
  }
  fs::path folderOf(const Job& job) const {
    return runsFolder(plan_, plan_.scenes[job.scene]) / fileNameFor(plan_.methods[job.method]) /
           fmt::format("seed-{}-{}", seedOf(job), hashOf(keyOf(job).dump()).substr(0, 8));
  }

  bool render(const Job& job, Repeat& run) {
    const ComparisonSetup::OneScene& setup = setup_.scenes[job.scene];
    const IntegratorChoice& method = setup.methods[job.method];
    const fs::path folder = folderOf(job);
    fs::create_directories(folder);
    run.seed = seedOf(job);

    RenderRequest request;
    request.seed = run.seed;
    request.threads = plan_.threads;
    request.stop = observer_.stop;
    request.marks = plan_.marks;
    if (plan_.timed)
      request.budget.seconds = plan_.marks.back();
    else
      request.budget.mutationsPerPixel = std::llround(plan_.marks.back());
    request.progress = [&](const RenderProgress& progress) {
      if (plan_.timed)
        aRun_ = plan_.marks.back();
      else if (progress.fraction > 0)
        aRun_ = progress.elapsedSeconds / progress.fraction;
      report(progress.elapsedSeconds);
    };
    std::size_t next = 0;
    request.atMark = [&](std::size_t mark, const RenderResult& result) {
      run.points.push_back(pointOf(job, folder, mark, result));
      next = mark + 1;
    };
    if (plan_.timed) aRun_ = plan_.marks.back();
    report(0);
    const RenderResult result = method.integrator->render(setup.scene, request);
    if (result.interrupted || next < plan_.marks.size()) return false;
    writeTextAtomically((folder / "record.json").string(),
                        recordOf(run, keyOf(job)).dump(1) + "\n");
    done_ += aRun_;
    return true;
  }

  Point pointOf(const Job& job, const fs::path& folder, std::size_t mark,
                const RenderResult& result) const {
    const IntegratorChoice& method = setup_.scenes[job.scene].methods[job.method];
    Point point;
    point.mark = plan_.marks[mark];
    point.seconds = result.wallSeconds;
    point.cpuSeconds = result.cpuSeconds;
    point.samples = static_cast<double>(result.samples);
    point.perPixel = point.samples / static_cast<double>(result.image.pixels.size());
    point.sampleUnit = result.sampleUnit;
    point.statistics = result.statistics;
    point.image = folder / fmt::format("mark-{}.exr", mark + 1);
    writeImage(point.image.string(), result.image,
               {{"scene", plan_.scenes[job.scene].file},
                {"integrator", method.options.integrator()},
                {"integratorOptions", optionText(method.options)},
                {"seed", std::to_string(seedOf(job))},
                {"threads", plan_.threads},
                {"wallSeconds", result.wallSeconds},
                {"cpuSeconds", result.cpuSeconds},
                {"samples", point.samples},
                {"sampleUnit", result.sampleUnit},
                {"meanLuminance", result.meanLuminance},
                {"meanLuminanceError", result.meanLuminanceError},
                {"programVersion", plan_.programVersion}});
    return point;
  }

  void report(double elapsed) {
    if (!observer_.status) return;
    status_.done = done_ + std::min(elapsed, aRun_);
    status_.total = done_ + aRun_ * static_cast<double>(remaining_);
    observer_.status(status_);
  }

  void collect(const std::vector<Job>& jobs, const std::vector<Repeat>& runs,
               std::vector<SceneRuns>& results) const {
    results.clear();
    for (std::size_t s = 0; s < plan_.scenes.size(); ++s) {
      const ComparisonSetup::OneScene& setup = setup_.scenes[s];
      SceneRuns scene{plan_.scenes[s], setup.scene.film.width, setup.scene.film.height, {}, {}};
      for (std::size_t m = 0; m < plan_.methods.size(); ++m) {
        const OptionSet& options = setup.methods[m].options;
        scene.methods.push_back({plan_.methods[m],
                                 options.integrator(),
                                 {options.values().begin(), options.values().end()},
                                 false,
                                 std::vector<Repeat>(static_cast<std::size_t>(plan_.repeats))});
      }
      results.push_back(std::move(scene));
    }
    for (std::size_t i = 0; i < jobs.size(); ++i)
      results[jobs[i].scene].methods[jobs[i].method].repeats[at(jobs[i].repeat)] = runs[i];
  }

  const ComparisonPlan& plan_;
  const ComparisonSetup& setup_;
  const ComparisonObserver& observer_;
  ComparisonStatus status_;
  double done_ = 0, aRun_ = 0;
  std::size_t remaining_ = 0;
};

}  // namespace

bool renderRuns(const ComparisonPlan& plan, const ComparisonSetup& setup,
                const ComparisonObserver& observer, std::vector<SceneRuns>& results) {
  return Runner(plan, setup, observer).run(results);
}

}  // namespace h2mc
