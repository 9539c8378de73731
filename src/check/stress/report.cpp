// SPDX-License-Identifier: MIT
#include "check/stress/report.h"

#include <fmt/format.h>

#include <cmath>

namespace h2mc {
namespace {

using nlohmann::json;

json number(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

json spread(const ErrorSpread& errors) {
  if (errors.replay.empty()) return {{"median", nullptr}, {"worst", nullptr}};
  return {{"median", number(errors.median)},
          {"worst", number(errors.worst)},
          {"worstReplay", errors.replay}};
}

json pictures(const PictureComparison& p) {
  if (!p.made) return nullptr;
  return {{"h2mc", {{"mean", number(p.h2mc.mean)}, {"error", number(p.h2mc.error)}}},
          {"bdpt", {{"mean", number(p.bdpt.mean)}, {"error", number(p.bdpt.error)}}},
          {"z", number(p.z)},
          {"resolved", p.resolved},
          {"disagrees", p.disagrees()},
          {"brokenPixels", p.brokenPixels}};
}

json variation(const VariationOutcome& outcome) {
  const StressFindings& f = outcome.findings;
  json result = {{"name", outcome.variation->name},
                 {"description", outcome.variation->description},
                 {"seconds", outcome.seconds},
                 {"failed", outcome.failed()}};
  if (!outcome.error.empty()) {
    result["error"] = outcome.error;
    return result;
  }
  result.update({{"paths", f.paths},
                 {"notFinite", f.notFinite},
                 {"fallbacks", f.fallbacks},
                 {"fallbackShare", f.fallbackShare()},
                 {"chainDerivatives", f.chains.computed},
                 {"chainFallbacks", f.chains.notFinite},
                 {"chainFallbackShare", f.chainFallbackShare()},
                 {"doubleNotFinite", f.doubleNotFinite},
                 {"value", spread(f.value)},
                 {"gradient", spread(f.gradient)},
                 {"hessian", spread(f.hessian)},
                 {"pictures", pictures(f.pictures)}});
  if (!f.firstNotFinite.empty()) result["firstNotFinite"] = f.firstNotFinite;
  if (!f.firstFallback.empty()) result["firstFallback"] = f.firstFallback;
  return result;
}

std::string small(const json& x) {
  return x.is_null() ? "-" : fmt::format("{:.1e}", x.get<double>());
}

std::string percent(const json& share) {
  const double x = 100 * share.get<double>();
  return x == 0 ? "0" : x < 0.01 ? "<.01" : fmt::format("{:.2f}", x);
}

// "0.12345 (0.5%)": a mean with its relative error.
std::string mean(const json& estimate) {
  if (estimate["mean"].is_null() || estimate["error"].is_null()) return "not finite";
  const double m = estimate["mean"], e = estimate["error"];
  return m > 0 ? fmt::format("{:.4g} ({:.1f}%)", m, 100 * e / m) : "0";
}

std::string line(const json& v) {
  if (v.contains("error")) {
    const std::string error = v["error"];
    return fmt::format("{:<15} FAILED: {}\n", v["name"].get<std::string>(),
                       error.substr(0, error.find('\n')));
  }
  std::string text = fmt::format("{:<15} {:>6} {:>6} {:>6} {:>6}", v["name"].get<std::string>(),
                                 v["paths"].get<long long>(), v["notFinite"].get<long long>(),
                                 percent(v["fallbackShare"]), percent(v["chainFallbackShare"]));
  for (const char* error : {"value", "gradient", "hessian"})
    text += fmt::format("  {:>7} {:>7}", small(v[error]["median"]), small(v[error]["worst"]));
  const json& p = v["pictures"];
  if (p.is_null()) {
    text += v["paths"] == 0 ? "  no light" : "";
  } else {
    text += fmt::format("  {:>17} {:>17} {:>5}", mean(p["h2mc"]), mean(p["bdpt"]),
                        p["z"].is_null() ? "-" : fmt::format("{:.1f}", p["z"].get<double>()));
    text += p["disagrees"] ? "  DIFFERS" : p["resolved"] ? "" : "  noisy";
    if (p["brokenPixels"] > 0)
      text += fmt::format("  {} PIXELS NOT FINITE", p["brokenPixels"].get<long long>());
  }
  return text + "\n";
}

// The variation in which an error is largest.
std::string worst(const json& report, const char* error, const char* title) {
  const json* found = nullptr;
  for (const json& v : report["variations"]) {
    if (!v.contains(error) || v[error]["worst"].is_null()) continue;
    if (!found || v[error]["worst"] > (*found)[error]["worst"]) found = &v;
  }
  if (!found) return "";
  return fmt::format("worst {}: {}, {} --only {} --replay \"{}\"\n", title,
                     small((*found)[error]["worst"]), report["command"].get<std::string>(),
                     (*found)["name"].get<std::string>(),
                     (*found)[error]["worstReplay"].get<std::string>());
}

}  // namespace

json stressReport(const StressSettings& settings, const std::vector<VariationOutcome>& outcomes,
                  const std::string& command) {
  json report = {{"command", command},          {"paths", settings.paths},
                 {"samples", settings.samples}, {"maxDepth", settings.maxLength},
                 {"seed", settings.seed},       {"variations", json::array()},
                 {"leftOut", json::array()}};
  int failed = 0;
  for (const VariationOutcome& outcome : outcomes) {
    failed += outcome.failed();
    if (outcome.applies)
      report["variations"].push_back(variation(outcome));
    else
      report["leftOut"].push_back(outcome.variation->name);
  }
  report["failed"] = failed;
  return report;
}

std::string stressTable(const json& report) {
  std::string text = fmt::format(
      "{:<15} {:>6} {:>6} {:^13}  {:^51}  {:^41}\n"
      "{:<15} {:>6} {:>6} {:^13}  {:^15}  {:^15}  {:^15}  {:>17} {:>17} {:>5}\n"
      "{:<15} {:>6} {:>6} {:>6} {:>6}  {:>7} {:>7}  {:>7} {:>7}  {:>7} {:>7}\n",
      "", "", "not", "fallback, %", "float against double", "mean luminance (standard error)", "",
      "", "finite", "of", "value", "gradient", "Hessian", "h2mc", "bdpt", "z", "", "paths", "",
      "paths", "chains", "median", "worst", "median", "worst", "median", "worst");
  for (const json& v : report["variations"]) text += line(v);
  std::string leftOut;
  for (const json& name : report["leftOut"])
    leftOut += (leftOut.empty() ? "" : ", ") + name.get<std::string>();
  if (!leftOut.empty()) text += "changes nothing here: " + leftOut + "\n";
  return text + worst(report, "value", "value") + worst(report, "gradient", "gradient") +
         worst(report, "hessian", "Hessian");
}

std::string stressFailures(const std::vector<VariationOutcome>& outcomes,
                           const std::string& command) {
  std::string text;
  for (const VariationOutcome& outcome : outcomes) {
    if (!outcome.failed()) continue;
    const std::string& name = outcome.variation->name;
    if (!outcome.error.empty()) {
      text += fmt::format("h2mc: {}: {}\n", name, outcome.error);
      continue;
    }
    const StressFindings& f = outcome.findings;
    if (f.notFinite > 0) {
      text += fmt::format("h2mc: {}: {} contributions are not finite\n", name, f.notFinite);
      if (!f.firstNotFinite.empty())
        text += fmt::format("  {} --only {} --replay \"{}\"\n", command, name, f.firstNotFinite);
    }
    if (f.pictures.brokenPixels > 0)
      text += fmt::format("h2mc: {}: {} pixels are not finite\n", name, f.pictures.brokenPixels);
    if (f.pictures.disagrees())
      text += fmt::format(
          "h2mc: {}: h2mc's pictures are not bdpt's: mean luminance {:.6g} and {:.6g}, {:.1f} "
          "standard errors in one of mean and balances\n",
          name, f.pictures.h2mc.mean, f.pictures.bdpt.mean, f.pictures.z);
  }
  return text;
}

}  // namespace h2mc
