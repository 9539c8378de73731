// SPDX-License-Identifier: MIT
#include "compare/results.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <thread>

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

// Relative to the comparison's folder, where it lies below it.
std::string shownPath(const std::filesystem::path& path, const ComparisonPlan& plan) {
  const std::filesystem::path relative = path.lexically_relative(plan.folder);
  return relative.empty() || *relative.begin() == ".." ? path.string() : relative.string();
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
  return {{"metric", summary.metric},
          {"timed", summary.timed},
          {"position", number(summary.position)},
          {"best", summary.best},
          {"methods", methods}};
}

json biasJson(const BiasCheck& b) {
  return {{"meanRatio", estimateJson(b.meanRatio)},   {"meanImageError", number(b.meanImageError)},
          {"varianceAlone", number(b.varianceAlone)}, {"squaredBias", number(b.squaredBias)},
          {"standardError", number(b.standardError)}, {"shows", b.shows},
          {"brightnessOff", b.brightnessOff}};
}

// The method's images of the same number in each repeat, as one point with an interval.
json curvesJson(const MethodRuns& method) {
  json curves = json::object();
  std::size_t marks = 0;
  for (const Repeat& repeat : method.repeats) marks = std::max(marks, repeat.points.size());
  for (const std::string& metric : comparedMetrics()) {
    json curve = json::array();
    for (std::size_t k = 0; k < marks; ++k) {
      std::vector<double> errors, seconds, perPixel;
      for (const Repeat& repeat : method.repeats) {
        if (k >= repeat.points.size()) continue;
        errors.push_back(repeat.points[k].errors.at(metric));
        seconds.push_back(repeat.points[k].seconds);
        perPixel.push_back(repeat.points[k].perPixel);
      }
      curve.push_back({{"seconds", number(geometricMean(seconds).value)},
                       {"perPixel", number(geometricMean(perPixel).value)},
                       {"error", estimateJson(geometricMean(errors))}});
    }
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

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

std::string optionsOf(const MethodRuns& method) {
  std::string text;
  for (const auto& [name, value] : method.options)
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", name, value);
  return text;
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

const std::vector<Summary>& mainSummaries(const SceneResults& scene, const ComparisonPlan& plan) {
  return plan.timed ? scene.byTime : scene.byMutation;
}

std::string position(const Summary& summary) {
  return summary.timed ? fmt::format("{:g} s", summary.position)
                       : fmt::format("{:g} mutations or samples a pixel", summary.position);
}

std::string biasText(const BiasCheck& bias) {
  return std::string(bias.brightnessOff ? "; BRIGHTNESS OFF" : "") +
         (bias.shows ? "; BIAS SHOWS" : "");
}

std::string latexText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string("_%&#$").find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

// 1.5e-3 as LaTeX has it.
std::string latexNumber(double value) {
  if (std::isnan(value)) return "--";
  if (std::isinf(value)) return "$\\infty$";
  if (value == 0 || (std::abs(value) >= 1e-2 && std::abs(value) < 1e4))
    return fmt::format("${:.3g}$", value);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
  return fmt::format("${:.2f}\\cdot 10^{{{}}}$", value / std::pow(10, exponent), exponent);
}

std::string latexEstimate(const Estimate& e) {
  std::string value = latexNumber(e.value);
  if (std::isnan(e.low)) return value;
  return fmt::format("{} {{\\scriptsize [{}, {}]}}", value, latexNumber(e.low),
                     latexNumber(e.high));
}

}  // namespace

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

std::string resultsCsv(const std::vector<SceneResults>& results, const ComparisonPlan& plan) {
  std::string csv =
      "scene,method,integrator,options,repeat,seed,mark,seconds,cpu_seconds,samples,per_pixel,"
      "sample_unit,mean_ratio";
  for (const std::string& metric : comparedMetrics()) csv += "," + metric;
  csv += ",image\n";
  for (const SceneResults& scene : results)
    for (const MethodRuns& method : scene.runs.methods)
      for (std::size_t r = 0; r < method.repeats.size(); ++r)
        for (const Point& p : method.repeats[r].points) {
          csv += fmt::format("{},{},{},{},{},{},{:g},{:.6g},{:.6g},{:.0f},{:.6g},{},{:.6g}",
                             quoted(scene.runs.scene.name), quoted(method.name),
                             method.external ? "external" : method.integrator,
                             quoted(optionsOf(method)), r + 1, method.repeats[r].seed, p.mark,
                             p.seconds, p.cpuSeconds, p.samples, p.perPixel, p.sampleUnit,
                             p.meanRatio);
          for (const std::string& metric : comparedMetrics())
            csv += fmt::format(",{:.6g}", p.errors.at(metric));
          csv += "," + quoted(shownPath(p.image, plan)) + "\n";
        }
  return csv;
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
            {"seed", plan.seed},
            {"threads", plan.threads},
            {"defines", plan.defines}}},
          {"confidence", kConfidence},
          {"metrics", metricList},
          {"scenes", scenes}};
}

std::string latexTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan) {
  std::string table =
      "% Written by h2mc compare. Needs the package booktabs.\n"
      "\\begin{tabular}{llllll}\n\\toprule\n"
      "scene & method & " +
      latexText(comparedMetrics().front()) +
      " & $p$ in $c\\,t^{-p}$ & error ratio & time to equal error \\\\\n";
  for (const SceneResults& scene : results) {
    const Summary& summary = mainSummaries(scene, plan).front();
    table += "\\midrule\n";
    for (std::size_t i = 0; i < summary.methods.size(); ++i) {
      const MethodSummary& m = summary.methods[i];
      table += fmt::format("{} & {} & {} & {} & {} & {}{} \\\\\n",
                           i == 0 ? latexText(scene.runs.scene.name) : "", latexText(m.name),
                           latexEstimate(m.error), latexNumber(m.p.value),
                           latexEstimate(m.errorRatio), latexEstimate(m.timeRatio),
                           m.verdict == "no difference shown" ? " (n.d.)" : "");
    }
  }
  return table + fmt::format(
                     "\\bottomrule\n\\end{{tabular}}\n"
                     "%% {} repeats, {:.0f} %% intervals; n.d.: no difference to the best shown.\n"
                     "%% {}\n",
                     plan.repeats, 100 * kConfidence, machineName());
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
    for (std::size_t i = 0; i < summary.methods.size(); ++i) {
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
