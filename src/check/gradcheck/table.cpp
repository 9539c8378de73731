// SPDX-License-Identifier: MIT
// gradcheck's findings as plain text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/gradcheck/report.h"
#include "check/gradcheck/verdict_names.h"
#include "render/core/index.h"
#include "render/path/path_text.h"
#include "render/path/path_vertices.h"
#include "render/scene/kinds.h"

namespace h2mc {
namespace {

using nlohmann::json;

std::string small(const json& x) {
  return x.is_null() ? "-" : fmt::format("{:.1e}", x.get<double>());
}

// "median  worst" of an error.
std::string spread(const json& errors) {
  return fmt::format("{:>8} {:>8}", small(errors["median"]), small(errors["worst"]));
}

std::string doubleLine(const std::string& name, const json& row) {
  return fmt::format("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}  {}  {}\n", name,
                     row["paths"].get<long long>(), row["judged"].get<long long>(),
                     row["kinkNearby"].get<long long>(), row["differenceNoise"].get<long long>(),
                     row["notFinite"].get<long long>(), row["outOfTolerance"].get<long long>(),
                     spread(row["gradient"]), spread(row["hessian"]));
}

std::string formLine(const std::string& name, const json& row, const std::string& form) {
  const json& f = row["forms"][form];
  return fmt::format("{:<16} {:>7} {:>7} {:>7} {:>7} {:>7}  {}  {}  {}\n", name,
                     row["paths"].get<long long>(), f["rounding"].get<long long>(),
                     f["notFinite"].get<long long>(), f["unsupported"].get<long long>(),
                     f["outOfTolerance"].get<long long>(), spread(f["value"]),
                     spread(f["gradient"]), spread(f["hessian"]));
}

template <class Line>
std::string allGroups(const json& report, Line&& line) {
  std::string text;
  for (const json& group : report["groups"]) {
    text += fmt::format("by {}\n", group["title"].get<std::string>());
    for (const json& row : group["rows"]) text += line("  " + row["name"].get<std::string>(), row);
  }
  return text + line("all", report["total"]);
}

std::string lobeText(const Scene& scene, const TracedVertex& v) {
  const Bsdf* const bsdf = bsdfSeen(scene, v);
  const Vec3f& p = v.vertex.point.p;
  return fmt::format("{:<16} {:<16} lobe {}{}{}  at ({:.6g}, {:.6g}, {:.6g}), cos {:.3g}\n",
                     scene.shapes[v.id.shape].name, bsdf ? kindOf(*bsdf) : "black", v.lobe.lobe,
                     v.lobe.back ? " back" : "", v.lobe.null ? " passed through" : "", p.x, p.y,
                     p.z, v.vertex.wi.z);
}

std::string describeVertices(const Scene& scene, const Path& path) {
  std::string text;
  const auto [s, t] = path.technique;
  for (int i = 1; i < t; ++i) {
    if (i == t - 1 && path.escaped)
      text += fmt::format("  camera {}  escapes to the environment\n", i);
    else
      text += fmt::format("  camera {}  {}", i, lobeText(scene, path.camera[at(i)]));
  }
  for (int i = s - 1; i >= 1; --i)
    text += fmt::format("  light {}   {}", i, lobeText(scene, path.light[at(i)]));
  if (path.lightIndex >= 0)
    text += fmt::format("  light     {}\n", kindOf(scene.lights[at(path.lightIndex)]));
  return text;
}

// In capitals where it is wrong.
template <class V>
const char* markedName(V verdict) {
  return verdict == V::kWrong ? "OUT OF TOLERANCE" : nameOf(verdict);
}

std::string entryLine(const std::string& name, const ad::EntryCheck& e,
                      const std::vector<double>& floats) {
  std::string line = fmt::format("  {:<8} {:>20.12g} {:>20.12g} {:>9.1e} {:>9.1e}", name, e.exact,
                                 e.difference, e.error / e.scale, e.relative);
  for (const double x : floats) line += fmt::format(" {:>14.7g}", x);
  return line + fmt::format("  {}\n", markedName(e.verdict));
}

}  // namespace

std::string gradcheckTable(const json& report) {
  std::string text = fmt::format(
      "double AD against differences in double, tolerance {:.3g}\n"
      "{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}  {:^17}  {:^17}\n"
      "{:<16} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}  {:>8} {:>8}  {:>8} {:>8}\n",
      report["tolerance"].get<double>(), "", "", "", "kink", "diff.", "not", "out of", "gradient",
      "Hessian", "", "paths", "judged", "nearby", "noise", "finite", "tol.", "median", "worst",
      "median", "worst");
  text += allGroups(report, doubleLine);
  const json& total = report["total"];
  text += fmt::format("entries judged {}, not judged {}\n", total["entriesJudged"].get<long long>(),
                      total["entriesNotJudged"].get<long long>());
  for (const json& form : report["forms"]) {
    const std::string name = form["name"];
    text += fmt::format(
        "\nfloat AD, {} form ({}), against double AD, tolerance {:.3g}\n"
        "{:<16} {:>7} {:>7} {:>7} {:>7} {:>7}  {:^17}  {:^17}  {:^17}\n"
        "{:<16} {:>7} {:>7} {:>7} {:>7} {:>7}  {:>8} {:>8}  {:>8} {:>8}  {:>8} {:>8}\n",
        name, form["description"].get<std::string>(), report["floatTolerance"].get<double>(), "",
        "", "", "not", "not", "out of", "value", "gradient", "Hessian", "", "paths", "round.",
        "finite", "supp.", "tol.", "median", "worst", "median", "worst", "median", "worst");
    text += allGroups(report, [&](const std::string& row, const json& values) {
      return formLine(row, values, name);
    });
  }
  return text;
}

std::string describePath(const Scene& scene, const SampledPath& sampled,
                         const GradcheckSettings& settings) {
  std::string text = pathText(sampled.technique, sampled.sample) + "\n";
  ad::DerivativeCheck check;
  const PathCheck result = checkPath(scene, sampled, settings, &check);
  Path path(std::max(settings.maxLength, sampled.technique.length()));
  path.technique = sampled.technique;
  path.sample = sampled.sample;
  tracePath(scene, path);
  // Where it broke off, its vertices are not all there.
  if (!result.traced && path.finite) return text + "  carries no light: target is zero\n";
  text += describeVertices(scene, path);
  if (!result.traced) return text + "  contribution is not finite\n";
  text += fmt::format("log target {:.9g} traced, {:.15g} in double (noise {:.1e})\n",
                      std::log(double(path.target)), check.value, check.noise);
  std::vector<ad::DerivativeValues> forms;
  std::string names;
  for (std::size_t k = 0; k < settings.forms.size(); ++k) {
    const FormCheck& f = result.forms[k];
    text +=
        fmt::format("float, {} form: {}; errors: value {:.2e}, gradient {:.2e}, Hessian {:.2e}\n",
                    settings.forms[k].name, markedName(f.verdict), f.value, f.gradient, f.hessian);
    ad::DerivativeValues values;
    if (!settings.forms[k].differentiate(scene, path, values)) continue;
    names += fmt::format(" {:>14}", settings.forms[k].name);
    forms.push_back(std::move(values));
  }
  if (!result.finite) return text + "double derivatives or the value are not finite\n";
  text += fmt::format("double AD: {}; errors: value {:.2e}, gradient {:.2e}, Hessian {:.2e}\n",
                      markedName(result.verdict), result.valueError, result.gradientError,
                      result.hessianError);
  text += fmt::format("  {:<8} {:>20} {:>20} {:>9} {:>9}{}\n", "entry", "double AD", "differences",
                      "est.error", "rel.error", names);
  const auto floats = [&](const auto& member, std::size_t k) {
    std::vector<double> values(forms.size());
    for (std::size_t f = 0; f < forms.size(); ++f) values[f] = (forms[f].*member)[k];
    return values;
  };
  for (std::size_t i = 0; i < check.gradient.size(); ++i)
    text += entryLine(fmt::format("g[{}]", i), check.gradient[i],
                      floats(&ad::DerivativeValues::gradient, i));
  for (std::size_t i = 0, k = 0; i < check.gradient.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++k)
      text += entryLine(fmt::format("H[{},{}]", i, j), check.hessian[k],
                        floats(&ad::DerivativeValues::hessian, k));
  return text;
}

}  // namespace h2mc
