// SPDX-License-Identifier: MIT
#include "compare/tables.h"

#include <fmt/format.h>

#include <cmath>

namespace h2mc {
namespace {

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

// Empty where it is not known.
std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value); }

std::string cells(const Estimate& e) {
  return cell(e.value) + "," + cell(e.low) + "," + cell(e.high);
}

}  // namespace

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

std::string errorsCsv(const std::vector<SceneResults>& results) {
  std::string csv = "scene,method,repeat,seed,mark,seconds,per_pixel,sample_unit,metric,value\n";
  for (const SceneResults& scene : results)
    for (const MethodRuns& method : scene.runs.methods)
      for (std::size_t r = 0; r < method.repeats.size(); ++r)
        for (const Point& p : method.repeats[r].points)
          for (const std::string& metric : comparedMetrics())
            csv += fmt::format("{},{},{},{},{:g},{:.6g},{:.6g},{},{},{:.6g}\n",
                               quoted(scene.runs.scene.name), quoted(method.name), r + 1,
                               method.repeats[r].seed, p.mark, p.seconds, p.perPixel, p.sampleUnit,
                               metric, p.errors.at(metric));
  return csv;
}

std::string summaryCsv(const std::vector<SceneResults>& results) {
  std::string csv =
      "scene,metric,axis,position,method,rank,verdict,p_value,error,error_low,error_high,by_fit,"
      "slope,slope_low,slope_high,error_ratio,error_ratio_low,error_ratio_high,cost_ratio,"
      "cost_ratio_low,cost_ratio_high\n";
  for (const SceneResults& scene : results)
    for (const auto* list : {&scene.byTime, &scene.byMutation})
      for (const Summary& summary : *list)
        for (const std::size_t i : summary.order) {
          const MethodSummary& m = summary.methods[i];
          csv +=
              fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted(scene.runs.scene.name),
                          summary.metric, summary.timed ? "time" : "work", cell(summary.position),
                          quoted(m.name), m.rank > 0 ? std::to_string(m.rank) : "",
                          quoted(m.verdict), cell(m.pValue), cells(m.error), m.byFit ? 1 : 0,
                          cells(m.p), cells(m.errorRatio), cells(m.timeRatio));
        }
  return csv;
}

}  // namespace h2mc
