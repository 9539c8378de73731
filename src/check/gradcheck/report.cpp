// SPDX-License-Identifier: MIT
#include "check/gradcheck/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "check/gradcheck/verdict_names.h"
#include "render/core/index.h"
#include "render/path/path_text.h"
#include "render/path/replay_double.h"
#include "render/scene/kinds.h"

namespace h2mc {
namespace {

using nlohmann::json;

// Paths that are shown one by one.
constexpr std::size_t kShown = 12;
constexpr int kSweepLevels = 30;

json number(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

// Median and largest of what was judged.
json spread(std::vector<double> errors) {
  if (errors.empty()) return {{"median", nullptr}, {"worst", nullptr}};
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  const double median = *middle;
  return {{"median", median}, {"worst", *std::max_element(errors.begin(), errors.end())}};
}

// Some paths' results in one row.
class Row {
 public:
  explicit Row(std::size_t forms) : forms_(forms) {}

  void add(const PathCheck& p) {
    ++paths_;
    if (!p.traced) {
      ++untraced_;
      return;
    }
    if (!p.finite) {
      ++notFinite_;
    } else {
      entries_ += p.agree + p.wrong;
      unjudged_ += p.noisy + p.kinked;
      ++verdicts_[at(p.verdict)];
      if (p.agree + p.wrong > 0) {
        gradient_.push_back(p.gradientError);
        hessian_.push_back(p.hessianError);
      }
    }
    for (std::size_t k = 0; k < forms_.size(); ++k) {
      const FormCheck& form = p.forms[k];
      Form& own = forms_[k];
      ++own.verdicts[at(form.verdict)];
      if (form.verdict == FormVerdict::kUnsupported || form.verdict == FormVerdict::kNotFinite)
        continue;
      own.value.push_back(form.value);
      own.gradient.push_back(form.gradient);
      own.hessian.push_back(form.hessian);
    }
  }

  json report(const GradcheckSettings& settings) const {
    const auto count = [&](ad::Verdict v) { return verdicts_[at(v)]; };
    json forms = json::object();
    for (std::size_t k = 0; k < forms_.size(); ++k) {
      const Form& f = forms_[k];
      const auto formCount = [&](FormVerdict v) { return f.verdicts[at(v)]; };
      forms[settings.forms[k].name] = {{"value", spread(f.value)},
                                       {"gradient", spread(f.gradient)},
                                       {"hessian", spread(f.hessian)},
                                       {"rounding", formCount(FormVerdict::kRounding)},
                                       {"notFinite", formCount(FormVerdict::kNotFinite)},
                                       {"unsupported", formCount(FormVerdict::kUnsupported)},
                                       {"outOfTolerance", formCount(FormVerdict::kWrong)}};
    }
    return {{"paths", paths_},
            {"judged", count(ad::Verdict::kAgrees) + count(ad::Verdict::kWrong)},
            {"kinkNearby", count(ad::Verdict::kKink)},
            {"differenceNoise", count(ad::Verdict::kNoise)},
            {"notFinite", notFinite_},
            {"notTraced", untraced_},
            {"outOfTolerance", count(ad::Verdict::kWrong)},
            {"entriesJudged", entries_},
            {"entriesNotJudged", unjudged_},
            {"gradient", spread(gradient_)},
            {"hessian", spread(hessian_)},
            {"forms", forms}};
  }

 private:
  struct Form {
    std::vector<double> value, gradient, hessian;
    std::array<long long, 5> verdicts{};
  };
  long long paths_ = 0, untraced_ = 0, notFinite_ = 0, entries_ = 0, unjudged_ = 0;
  std::array<long long, 4> verdicts_{};
  std::vector<double> gradient_, hessian_;
  std::vector<Form> forms_;
};

// The tables: a title, and the rows of which a path is part.
struct Grouping {
  const char* title;
  std::vector<std::string> (*rows)(const PathCheck& path);
};

const Grouping kGroupings[] = {
    {"technique (s,t)",
     [](const PathCheck& p) {
       const auto [s, t] = p.path.technique;
       return std::vector{"(" + std::to_string(s) + "," + std::to_string(t) + ")"};
     }},
    {"BSDF at a vertex",
     [](const PathCheck& p) {
       std::vector<std::string> names;
       for (std::size_t k = 0; k < bsdfKinds().size(); ++k)
         if ((p.traits.bsdfs >> k) & 1) names.emplace_back(bsdfKinds()[k]);
       if (names.empty()) names.emplace_back("none");
       return names;
     }},
    {"light",
     [](const PathCheck& p) { return std::vector{std::string(lightKinds()[at(p.traits.light)])}; }},
    {"motion",
     [](const PathCheck& p) {
       return std::vector{std::string(p.traits.moving ? "moving" : "still")};
     }},
    {"sampler", [](const PathCheck& p) { return std::vector{std::string(nameOf(p.path.origin))}; }},
};

json groupsOf(const GradcheckSettings& settings, const GradcheckResult& result) {
  json groups = json::array();
  for (const Grouping& grouping : kGroupings) {
    std::vector<std::string> order;
    std::map<std::string, Row> rows;
    for (const PathCheck& p : result.paths)
      for (const std::string& name : grouping.rows(p)) {
        const auto [row, isNew] = rows.try_emplace(name, settings.forms.size());
        if (isNew) order.push_back(name);
        row->second.add(p);
      }
    // Techniques in their own order: by length, then by s.
    if (&grouping != &kGroupings[0]) std::sort(order.begin(), order.end());
    json list = json::array();
    for (const std::string& name : order) {
      json row = rows.at(name).report(settings);
      row["name"] = name;
      list.push_back(std::move(row));
    }
    groups.push_back({{"title", grouping.title}, {"rows", std::move(list)}});
  }
  return groups;
}

// Errors by powers of ten: counts[k] are those in [10^(first + k), 10^(first + k + 1)).
class Histogram {
 public:
  static constexpr int kFirst = -17, kBins = 20;
  void add(double error) {
    const double power = error > 0 ? std::floor(std::log10(error)) : kFirst;
    const double bin = std::clamp(power - kFirst, 0.0, double(kBins - 1));
    ++counts_[at(bin)];
  }
  const std::array<long long, kBins>& counts() const { return counts_; }

 private:
  std::array<long long, kBins> counts_{};
};

json histogramsOf(const GradcheckSettings& settings, const GradcheckResult& result) {
  json histograms = json::array();
  const auto push = [&](const std::string& title, double tolerance, const auto& errors) {
    Histogram gradient, hessian;
    for (const PathCheck& p : result.paths)
      if (const auto e = errors(p); e.first >= 0) {
        gradient.add(e.first);
        hessian.add(e.second);
      }
    histograms.push_back({{"title", title},
                          {"first", Histogram::kFirst},
                          {"tolerance", tolerance},
                          {"gradient", gradient.counts()},
                          {"hessian", hessian.counts()}});
  };
  using Errors = std::pair<double, double>;
  push("double against differences", settings.tolerance, [](const PathCheck& p) {
    return p.finite && p.agree + p.wrong > 0 ? Errors(p.gradientError, p.hessianError)
                                             : Errors(-1, -1);
  });
  for (std::size_t k = 0; k < settings.forms.size(); ++k)
    push(std::string("float (") + settings.forms[k].name + ") against double",
         settings.floatTolerance, [k](const PathCheck& p) {
           const FormCheck& f = p.forms[k];
           const bool has =
               f.verdict != FormVerdict::kUnsupported && f.verdict != FormVerdict::kNotFinite;
           return has ? Errors(f.gradient, f.hessian) : Errors(-1, -1);
         });
  return histograms;
}

// The sweep of steps behind the entry with the largest error.
json sweepOf(const Scene& scene, const SampledPath& sampled, const ad::DerivativeCheck& check) {
  const ad::EntryCheck* worst = nullptr;
  int row = 0, column = -1;
  const auto consider = [&](const ad::EntryCheck& e, int i, int j) {
    const auto rank = [](const ad::EntryCheck& a) {
      return std::pair(a.verdict == ad::Verdict::kWrong,
                       std::isfinite(a.relative) ? a.relative : 0);
    };
    if (!worst || rank(*worst) < rank(e)) worst = &e, row = i, column = j;
  };
  for (std::size_t i = 0; i < check.gradient.size(); ++i)
    consider(check.gradient[i], static_cast<int>(i), -1);
  for (int i = 0, k = 0; i < static_cast<int>(check.gradient.size()); ++i)
    for (int j = 0; j <= i; ++j, ++k) consider(check.hessian[at(k)], i, j);
  if (!worst) return nullptr;

  Path path(sampled.technique.length());
  path.technique = sampled.technique;
  path.sample = sampled.sample;
  if (!tracePath(scene, path)) return nullptr;
  double u[kMaxCoordinates];
  pathCoordinates(path, u);
  const std::vector<double> largest = largestSteps(path);
  const double step = largest[at(row)];
  if (!(step > 0)) return nullptr;
  const double ratio = column < 0 ? 1 : largest[at(column)] / step;
  const ad::PlainFunction f = [&](const double* x) { return replayInDouble(scene, path, x); };
  json points = json::array();
  for (const ad::SweepPoint& p :
       ad::sweepEntry(f, u, path.dimension(), row, column, step, ratio, kSweepLevels))
    points.push_back({p.step, number(std::abs(p.quotient - worst->exact) / worst->scale),
                      number(std::abs(p.extrapolated - worst->exact) / worst->scale)});
  return {{"entry", column < 0 ? json({row}) : json({row, column})},
          {"exact", worst->exact},
          {"difference", number(worst->difference)},
          {"estimatedError", number(worst->error / worst->scale)},
          {"relativeError", number(worst->relative)},
          {"verdict", nameOf(worst->verdict)},
          {"points", points}};
}

json pathReport(const Scene& scene, const GradcheckSettings& settings, const PathCheck& p) {
  ad::DerivativeCheck details;
  checkPath(scene, p.path, settings, &details);
  json forms = json::object();
  for (std::size_t k = 0; k < settings.forms.size(); ++k)
    forms[settings.forms[k].name] = {{"verdict", nameOf(p.forms[k].verdict)},
                                     {"value", number(p.forms[k].value)},
                                     {"gradient", number(p.forms[k].gradient)},
                                     {"hessian", number(p.forms[k].hessian)}};
  json bsdfs = json::array();
  for (std::size_t k = 0; k < bsdfKinds().size(); ++k)
    if ((p.traits.bsdfs >> k) & 1) bsdfs.push_back(bsdfKinds()[k]);
  return {{"replay", pathText(p.path.technique, p.path.sample)},
          {"sampledBy", nameOf(p.path.origin)},
          {"name", nameOf(p.path)},
          {"s", p.path.technique.s},
          {"t", p.path.technique.t},
          {"bsdfs", bsdfs},
          {"light", lightKinds()[at(p.traits.light)]},
          {"finite", p.finite},
          {"verdict", p.finite ? nameOf(p.verdict) : "not finite"},
          {"entries",
           {{"agree", p.agree},
            {"differenceNoise", p.noisy},
            {"kinkNearby", p.kinked},
            {"outOfTolerance", p.wrong}}},
          {"valueError", number(p.valueError)},
          {"gradientError", number(p.gradientError)},
          {"hessianError", number(p.hessianError)},
          {"forms", forms},
          {"sweep", sweepOf(scene, p.path, details)}};
}

// The paths most worth a look, without repeats: failures, those that are not finite, then the largest
// errors in double and in each form by turns.
std::vector<const PathCheck*> worstPaths(const GradcheckSettings& settings,
                                         const GradcheckResult& result) {
  std::vector<const PathCheck*> chosen;
  std::set<const PathCheck*> seen;
  const auto take = [&](std::size_t most, const auto& rank) {
    std::vector<std::pair<double, const PathCheck*>> ranked;
    for (const PathCheck& p : result.paths)
      if (const double r = rank(p); r > 0) ranked.emplace_back(r, &p);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [r, p] : ranked) {
      if (most == 0 || chosen.size() >= kShown) return;
      if (!seen.insert(p).second) continue;
      chosen.push_back(p);
      --most;
    }
  };
  take(kShown, [](const PathCheck& p) {
    return p.verdict == ad::Verdict::kWrong ? 1e-30 + std::max(p.gradientError, p.hessianError) : 0;
  });
  take(kShown, [](const PathCheck& p) { return double(p.failed()); });
  take(2, [](const PathCheck& p) { return double(p.traced && !p.finite); });
  take(kShown / 2, [](const PathCheck& p) { return std::max(p.gradientError, p.hessianError); });
  for (std::size_t k = 0; k < settings.forms.size(); ++k)
    take(kShown, [k](const PathCheck& p) {
      return double(std::max(p.forms[k].gradient, p.forms[k].hessian));
    });
  return chosen;
}

}  // namespace

json gradcheckReport(const Scene& scene, const GradcheckSettings& settings,
                     const GradcheckResult& result) {
  Row total(settings.forms.size());
  for (const PathCheck& p : result.paths) total.add(p);
  json forms = json::array();
  for (const DerivativeForm& form : settings.forms)
    forms.push_back({{"name", form.name}, {"description", form.description}});
  json worst = json::array();
  for (const PathCheck* p : worstPaths(settings, result))
    worst.push_back(pathReport(scene, settings, *p));
  return {{"scene", scene.file},
          {"seed", settings.seed},
          {"maxDepth", settings.maxLength},
          {"tolerance", settings.tolerance},
          {"floatTolerance", settings.floatTolerance},
          {"interrupted", result.interrupted},
          {"pathsOutOfTolerance", result.failures()},
          {"forms", forms},
          {"total", total.report(settings)},
          {"groups", groupsOf(settings, result)},
          {"histograms", histogramsOf(settings, result)},
          {"worst", worst}};
}

}  // namespace h2mc
