// SPDX-License-Identifier: MIT
#include "compare/results.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "compare/curves.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

using nlohmann::json;

json number(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

json estimateJson(const Estimate& e) {
  return {{"value", number(e.value)}, {"low", number(e.low)}, {"high", number(e.high)}};
}

json summaryJson(const Summary& summary) {
  json methods = json::array();
  for (const MethodSummary& m : summary.methods)
    methods.push_back({{"name", m.name},
                       {"error", estimateJson(m.error)},
                       {"byFit", m.byFit},
                       {"p", estimateJson(m.p)},
                       {"logC", m.fit.valid ? number(m.fit.logC) : json(nullptr)},
                       {"errorRatio", estimateJson(m.errorRatio)},
                       {"timeRatio", estimateJson(m.timeRatio)},
                       {"pValue", number(m.pValue)},
                       {"rank", m.rank},
                       {"verdict", m.verdict}});
  return {
      {"metric", summary.metric}, {"timed", summary.timed}, {"position", number(summary.position)},
      {"best", summary.best},     {"order", summary.order}, {"methods", methods}};
}

json biasJson(const BiasCheck& b) {
  return {{"meanRatio", estimateJson(b.meanRatio)},   {"meanImageError", number(b.meanImageError)},
          {"varianceAlone", number(b.varianceAlone)}, {"squaredBias", number(b.squaredBias)},
          {"standardError", number(b.standardError)}, {"shows", b.shows},
          {"brightnessOff", b.brightnessOff}};
}

json curvesJson(const MethodRuns& method) {
  json curves = json::object();
  for (const std::string& metric : comparedMetrics()) {
    json curve = json::array();
    for (const CurvePoint& p : methodCurve(method, metric, true))
      curve.push_back({{"seconds", number(p.seconds)},
                       {"perPixel", number(p.perPixel)},
                       {"error", estimateJson(p.error)},
                       {"band", {{"low", number(p.bandLow)}, {"high", number(p.bandHigh)}}}});
    curves[metric] = curve;
  }
  return curves;
}

json methodJson(const MethodRuns& method, const BiasCheck& bias, const ComparisonPlan& plan) {
  json repeats = json::array();
  for (const Repeat& repeat : method.repeats) {
    json points = json::array();
    for (const Point& p : repeat.points) {
      json errors = json::object();
      for (const auto& [name, value] : p.errors) errors[name] = number(value);
      points.push_back({{"mark", p.mark},
                        {"seconds", p.seconds},
                        {"cpuSeconds", p.cpuSeconds},
                        {"samples", p.samples},
                        {"perPixel", p.perPixel},
                        {"sampleUnit", p.sampleUnit},
                        {"image", shownPath(p.image, plan)},
                        {"meanRatio", number(p.meanRatio)},
                        {"errors", errors},
                        {"statistics", p.statistics}});
    }
    repeats.push_back({{"seed", repeat.seed}, {"points", points}});
  }
  return {{"name", method.name},         {"integrator", method.integrator},
          {"options", method.options},   {"external", method.external},
          {"repeats", repeats},          {"bias", biasJson(bias)},
          {"curves", curvesJson(method)}};
}

// "1.52", "1.5 .. 2.2" rounded to what the interval deserves.
std::string text(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "inf";
  return fmt::format("{:.3g}", value);
}

std::string interval(const Estimate& e) {
  return std::isnan(e.low) ? "" : fmt::format("{} .. {}", text(e.low), text(e.high));
}

std::string biasText(const BiasCheck& bias) {
  return std::string(bias.brightnessOff ? "; BRIGHTNESS OFF" : "") +
         (bias.shows ? "; BIAS SHOWS" : "");
}

}  // namespace

const std::vector<Summary>& mainSummaries(const SceneResults& scene, const ComparisonPlan& plan) {
  return plan.timed ? scene.byTime : scene.byMutation;
}

std::string position(const Summary& summary) {
  return summary.timed ? fmt::format("{:g} s", summary.position)
                       : fmt::format("{:g} mutations or samples a pixel", summary.position);
}

std::string shownPath(const std::filesystem::path& path, const ComparisonPlan& plan) {
  const std::filesystem::path relative = path.lexically_relative(plan.folder);
  return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
}

SceneResults resultsOf(SceneRuns runs, const ComparisonPlan& plan, const Image& reference) {
  SceneResults results;
  for (const MethodRuns& method : runs.methods)
    results.bias.push_back(checkBias(method, reference, runs.reference));
  for (const std::string& metric : comparedMetrics()) {
    results.byTime.push_back(summarise(runs, plan, metric, true));
    results.byMutation.push_back(summarise(runs, plan, metric, false));
  }
  results.runs = std::move(runs);
  return results;
}

json resultsJson(const std::vector<SceneResults>& results, const ComparisonPlan& plan) {
  json metricList = json::array();
  for (const std::string& name : comparedMetrics())
    metricList.push_back({{"name", name}, {"description", findMetric(name)->description}});
  json scenes = json::array();
  for (const SceneResults& scene : results) {
    const SceneRuns& runs = scene.runs;
    json methods = json::array(), summaries = json::array();
    for (std::size_t m = 0; m < runs.methods.size(); ++m)
      methods.push_back(methodJson(runs.methods[m], scene.bias[m], plan));
    for (const auto* list : {&scene.byTime, &scene.byMutation})
      for (const Summary& summary : *list) summaries.push_back(summaryJson(summary));
    scenes.push_back({{"name", runs.scene.name},
                      {"file", runs.scene.file},
                      {"width", runs.width},
                      {"height", runs.height},
                      {"reference",
                       {{"image", shownPath(runs.reference.file, plan)},
                        {"origin", runs.reference.origin},
                        {"relmse", number(runs.reference.error)},
                        {"seconds", runs.reference.seconds},
                        {"goodEnough", runs.reference.goodEnough}}},
                      {"methods", methods},
                      {"summaries", summaries}});
  }
  return {{"program", "h2mc"},
          {"programVersion", plan.programVersion},
          {"machine", machineName()},
          {"plan",
           {{"timed", plan.timed},
            {"marks", plan.marks},
            {"repeats", plan.repeats},
            {"bandsAreRanges", plan.repeats < kLeastForBands},
            {"seed", plan.seed},
            {"threads", plan.threads},
            {"defines", plan.defines}}},
          {"confidence", kConfidence},
          {"metrics", metricList},
          {"scenes", scenes}};
}

std::string textTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan) {
  std::size_t width = 6;
  for (const SceneResults& scene : results)
    for (const MethodRuns& method : scene.runs.methods) width = std::max(width, method.name.size());
  std::string out;
  for (const SceneResults& scene : results) {
    const Summary& summary = mainSummaries(scene, plan).front();
    out += fmt::format("{}, {} at {}; reference: {}{}\n", scene.runs.scene.name, summary.metric,
                       position(summary), scene.runs.reference.origin,
                       scene.runs.reference.error > 0
                           ? fmt::format(", own relmse {:.2g}", scene.runs.reference.error)
                           : "");
    out += fmt::format("  {:<{}}  {:>9}  {:>20}  {:>6}  {:>9}  {:>16}  {:>7}  {}\n", "method",
                       width, "error", "95 % interval", "slope", "time x", "95 % interval", "mean",
                       "verdict");
    for (const std::size_t i : summary.order) {
      const MethodSummary& m = summary.methods[i];
      const BiasCheck& bias = scene.bias[i];
      out += fmt::format("  {:<{}}  {:>9}  {:>20}  {:>6}  {:>9}  {:>16}  {:>7}  {}{}\n", m.name,
                         width, text(m.error.value), interval(m.error), text(m.p.value),
                         text(m.timeRatio.value), interval(m.timeRatio),
                         fmt::format("{:.4f}", bias.meanRatio.value), m.verdict, biasText(bias));
    }
  }
  return out;
}

std::string machineName() {
  std::string model = "unknown processor";
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
      model = line.substr(line.find(": ") + 2);
      break;
    }
  return fmt::format("{}, {} hardware threads", model, std::thread::hardware_concurrency());
}

}  // namespace h2mc
