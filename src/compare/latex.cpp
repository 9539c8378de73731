// SPDX-License-Identifier: MIT
#include "compare/latex.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace h2mc {
namespace {

std::string latexText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("_%&#${}").find(c) != std::string_view::npos)
      result += std::string("\\") + c;
    else if (c == '\\')
      result += "\\textbackslash{}";
    else if (c == '~')
      result += "\\textasciitilde{}";
    else if (c == '^')
      result += "\\textasciicircum{}";
    else if (c == '<' || c == '>')
      result += fmt::format("${}$", c);
    else
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

std::string caption(const PaperFigure& figure, const SceneResults& scene,
                    const ComparisonPlan& plan) {
  const Summary& summary = mainSummaries(scene, plan).front();
  const std::string name = latexText(scene.runs.scene.name), metric = latexText(summary.metric);
  if (figure.kind == PaperFigure::Kind::kStrip)
    return fmt::format("\\emph{{{}}} at equal {}, {}. Below each: {} and time of the picture.",
                       name, summary.timed ? "time" : "work", position(summary), metric);
  const std::string band =
      plan.repeats < 2 ? "one run of each method"
      : plan.repeats < kLeastForBands
          ? fmt::format("bands: from the better to the worse of {} runs", plan.repeats)
          : fmt::format("bands: {:.0f}\\,\\% intervals of the mean of {} runs", 100 * kConfidence,
                        plan.repeats);
  return fmt::format("\\emph{{{}}}: {} against {}; {}. {}.", name, metric,
                     figure.kind == PaperFigure::Kind::kTime ? "time" : "work", band,
                     latexText(machineName()));
}

}  // namespace

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
    for (const std::size_t i : summary.order) {
      const MethodSummary& m = summary.methods[i];
      table += fmt::format("{} & {} & {} & {} & {} & {}{} \\\\\n",
                           i == summary.order.front() ? latexText(scene.runs.scene.name) : "",
                           latexText(m.name), latexEstimate(m.error), latexNumber(m.p.value),
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

std::string latexFigures(const std::vector<PaperFigure>& figures,
                         const std::vector<SceneResults>& results, const ComparisonPlan& plan) {
  std::string text = "% Written by h2mc compare. Needs the package graphicx.\n";
  for (const PaperFigure& figure : figures) {
    // What is two columns wide takes both.
    const bool wide = figure.kind == PaperFigure::Kind::kStrip;
    const char* const environment = wide ? "figure*" : "figure";
    text += fmt::format(
        "\\begin{{{}}}\n\\centering\n\\includegraphics[width=\\{}]{{{}}}\n\\caption{{{}}}\n"
        "\\end{{{}}}\n",
        environment, wide ? "textwidth" : "columnwidth", figure.file,
        caption(figure, results[figure.scene], plan), environment);
  }
  return text;
}

std::string latexDocument(bool withFigures) {
  return std::string(
             "% Written by h2mc compare. pdflatex paper.tex\n"
             "\\documentclass[twocolumn]{article}\n"
             "\\usepackage[margin=2cm]{geometry}\n"
             "\\usepackage{booktabs,graphicx}\n"
             "\\begin{document}\n"
             "\\begin{table*}\n\\centering\n\\small\n"
             "\\resizebox{\\ifdim\\width>\\textwidth\\textwidth\\else\\width\\fi}{!}{\\input{"
             "results}}\n"
             "\\end{table*}\n") +
         (withFigures ? "\\input{figures}\n" : "") + "\\end{document}\n";
}

}  // namespace h2mc
