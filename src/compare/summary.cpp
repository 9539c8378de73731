// SPDX-License-Identifier: MIT
#include "compare/summary.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "render/core/index.h"

namespace h2mc {
namespace {

constexpr double kSamePosition = 0.05;  // of the logarithm
constexpr double kLevel = 1 - kConfidence;
constexpr double kSmallest = 1e-300;  // an error of 0 has no logarithm

// One repeat on the axis.
struct Line {
  PowerLaw fit;
  double logError = std::numeric_limits<double>::quiet_NaN();  // at the position
  bool byFit = false;
};

Line lineOf(const Repeat& repeat, const std::string& metric, bool timed, double position) {
  Line line;
  std::vector<TimedError> points;
  double nearest = kSamePosition, samples = 0;
  for (const Point& point : repeat.points) {
    const double at = point.position(timed);
    const double error = std::max(point.errors.at(metric), kSmallest);
    if (!(at > 0) || !std::isfinite(error)) continue;
    // Marks within one round of samples are one point.
    if (!points.empty() && point.samples > 0 && point.samples == samples) points.pop_back();
    samples = point.samples;
    points.push_back({at, error});
    const double distance = std::abs(std::log(at / position));
    if (distance < nearest) {
      nearest = distance;
      line.logError = std::log(error);
    }
  }
  line.fit = fitPowerLaw(points);
  if (std::isnan(line.logError) && line.fit.valid) {
    line.logError = line.fit.logError(position);
    line.byFit = true;
  }
  return line;
}

struct MethodLines {
  std::vector<double> logErrors, slopes, intercepts;
  bool byFit = false;
};

MethodLines linesOf(const MethodRuns& method, const std::string& metric, bool timed,
                    double position) {
  MethodLines lines;
  for (const Repeat& repeat : method.repeats) {
    const Line line = lineOf(repeat, metric, timed, position);
    if (!std::isnan(line.logError)) lines.logErrors.push_back(line.logError);
    lines.byFit |= line.byFit;
    if (line.fit.valid) {
      lines.slopes.push_back(line.fit.p);
      lines.intercepts.push_back(line.fit.logC);
    }
  }
  return lines;
}

Estimate exponential(const Estimate& e) {
  return {std::exp(e.value), std::exp(e.low), std::exp(e.high)};
}

// How much longer a method takes to the best one's error: along its fitted slope, from the difference
// of the errors at the position.
Estimate timeRatio(const MethodLines& own, const MethodLines& best) {
  Estimate result;
  const SampleMoments slope = sampleMoments(own.slopes);
  if (slope.count == 0 || own.logErrors.empty() || best.logErrors.empty()) return result;
  const Estimate gap = differenceOfMeans(own.logErrors, best.logErrors);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!(slope.mean > 0)) {
    result.value = gap.value > 0 ? kInfinity : std::nan("");
    return result;
  }
  result.value = std::exp(gap.value / slope.mean);
  if (slope.count < 2 || std::isnan(gap.low)) return result;
  // Error propagation through gap / slope, the two taken as independent.
  const double halfGap = (gap.high - gap.low) / 2;
  const double halfSlope = studentQuantile(slope.count - 1) * std::sqrt(slope.varianceOfMean());
  if (halfSlope >= slope.mean) {  // the error may not fall at all
    result.low = std::exp(std::min(0.0, (gap.value - halfGap) / slope.mean));
    result.high = kInfinity;
    return result;
  }
  const double half =
      std::hypot(halfGap / slope.mean, gap.value * halfSlope / (slope.mean * slope.mean));
  result.low = std::exp(gap.value / slope.mean - half);
  result.high = std::exp(gap.value / slope.mean + half);
  return result;
}

double positionOf(const SceneRuns& runs, const ComparisonPlan& plan, bool timed) {
  if (timed == plan.timed) return plan.marks.back();
  double shortest = std::numeric_limits<double>::infinity();
  for (const MethodRuns& method : runs.methods)
    if (!method.external)
      for (const Repeat& repeat : method.repeats)
        shortest = std::min(shortest, repeat.points.back().position(timed));
  return shortest;
}

struct Pair {
  std::size_t a, b;
};

void rank(Summary& summary, const std::vector<MethodLines>& lines) {
  std::vector<Pair> pairs;
  std::vector<double> pValues;
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = a + 1; b < lines.size(); ++b) {
      if (!summary.methods[a].present || !summary.methods[b].present) continue;
      pairs.push_back({a, b});
      pValues.push_back(welchTest(lines[a].logErrors, lines[b].logErrors));
    }
  const std::vector<double> adjusted = holmAdjusted(pValues);
  const std::size_t best = static_cast<std::size_t>(summary.best);
  for (MethodSummary& method : summary.methods) method.rank = method.present ? 1 : 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    MethodSummary &a = summary.methods[pairs[k].a], &b = summary.methods[pairs[k].b];
    if (pairs[k].a == best) b.pValue = adjusted[k];
    if (pairs[k].b == best) a.pValue = adjusted[k];
    if (adjusted[k] < kLevel) ++(a.error.value > b.error.value ? a : b).rank;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    MethodSummary& method = summary.methods[i];
    if (!method.present)
      method.verdict = "no image at this position";
    else if (i == best)
      method.verdict = "best";
    else if (std::isnan(method.pValue))
      method.verdict = "one repeat: nothing can be shown";
    else
      method.verdict = method.pValue < kLevel ? "worse" : "no difference shown";
    // Another one with less scatter may be shown to be better than it: that says nothing of the best.
    if (method.present && method.verdict != "worse") method.rank = 1;
  }
}

void sortMethods(Summary& summary) {
  summary.order.resize(summary.methods.size());
  std::iota(summary.order.begin(), summary.order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const MethodSummary& m = summary.methods[i];
    return std::tuple(!m.present, m.rank, m.present ? m.error.value : 0.0);
  };
  std::stable_sort(summary.order.begin(), summary.order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
}

}  // namespace

Summary summarise(const SceneRuns& runs, const ComparisonPlan& plan, const std::string& metric,
                  bool timed) {
  Summary summary;
  summary.metric = metric;
  summary.timed = timed;
  summary.position = positionOf(runs, plan, timed);
  std::vector<MethodLines> lines;
  for (const MethodRuns& method : runs.methods) {
    lines.push_back(linesOf(method, metric, timed, summary.position));
    const MethodLines& own = lines.back();
    MethodSummary result;
    result.name = method.name;
    result.present = !own.logErrors.empty();
    result.error = exponential(meanEstimate(own.logErrors));
    result.byFit = own.byFit;
    result.p = meanEstimate(own.slopes);
    result.fit = {sampleMoments(own.intercepts).mean, sampleMoments(own.slopes).mean,
                  !own.slopes.empty()};
    if (result.present &&
        (summary.best < 0 || result.error.value < summary.methods[at(summary.best)].error.value))
      summary.best = static_cast<int>(summary.methods.size());
    summary.methods.push_back(std::move(result));
  }
  if (summary.best < 0) {
    sortMethods(summary);
    return summary;
  }
  const MethodLines& best = lines[at(summary.best)];
  for (std::size_t i = 0; i < lines.size(); ++i) {
    MethodSummary& method = summary.methods[i];
    if (!method.present) continue;
    if (static_cast<int>(i) == summary.best) {
      method.errorRatio = method.timeRatio = {1, 1, 1};
      continue;
    }
    method.errorRatio = exponential(differenceOfMeans(lines[i].logErrors, best.logErrors));
    method.timeRatio = timeRatio(lines[i], best);
  }
  rank(summary, lines);
  sortMethods(summary);
  return summary;
}

const Point* shownPoint(const MethodRuns& method, double position, bool timed) {
  const Point* nearest = nullptr;
  if (method.repeats.empty()) return nullptr;
  for (const Point& point : method.repeats.front().points) {
    const auto distance = [&](const Point& p) {
      return std::abs(std::log(p.position(timed) / position));
    };
    if (!nearest || distance(point) <= distance(*nearest)) nearest = &point;
  }
  return nearest;
}

}  // namespace h2mc
