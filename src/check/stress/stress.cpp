// SPDX-License-Identifier: MIT
#include "check/stress/stress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/gradcheck/form_check.h"
#include "check/gradcheck/path_source.h"
#include "mcmc/mutations/gaussian.h"
#include "render/core/index.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/path_text.h"
#include "render/path/replay_double.h"

namespace h2mc {
namespace {

constexpr int kBlock = 16;
// Beyond so many edges the derivatives in double are made in the local form: the plain one takes a time
// that grows with the cube of the length.
constexpr int kLongestPlain = 8;

struct PathFinding {
  bool traced = false, finite = true, fallback = false, compared = false;
  FormCheck errors;
};

PathFinding look(const Scene& scene, const SampledPath& sampled) {
  PathFinding found;
  Path path(sampled.technique.length());
  path.technique = sampled.technique;
  path.sample = sampled.sample;
  found.traced = tracePath(scene, path);
  found.finite = path.finite;
  if (!found.traced) return found;

  static thread_local Derivative derivative;
  static thread_local Gaussian gaussian;
  differentiate(scene, path, derivative);
  found.fallback = !hamiltonianGaussian(derivative, HamiltonianSettings(), gaussian);

  double u[kMaxCoordinates];
  pathCoordinates(path, u);
  const ad::DerivativeValues exact = path.technique.length() <= kLongestPlain
                                         ? differentiateInDouble(scene, path, u)
                                         : differentiateLocallyInDouble(scene, path, u);
  if (!exact.finite()) return found;
  ad::DerivativeValues inFloat;
  copyDerivative(derivative, inFloat);
  found.errors = formErrors(inFloat, exact);
  found.compared = true;
  return found;
}

// The paths with single coordinates and choices, and then all of them, at `border`.
std::vector<SampledPath> atBorder(const std::vector<SampledPath>& paths, float border,
                                  const SharedCoordinates& shared) {
  std::vector<SampledPath> placed;
  for (const SampledPath& path : paths) {
    const auto dimension = at(path.technique.dimension());
    const auto choices = at(path.technique.choices());
    for (std::size_t k = 0; k < dimension; ++k) {
      placed.push_back(path);
      placed.back().sample.u[k] = border;
    }
    for (std::size_t k = 0; k < choices; ++k) {
      placed.push_back(path);
      placed.back().sample.choice[k] = border;
    }
    SampledPath all = path;
    std::fill_n(all.sample.u.begin(), dimension, border);
    float x[kMostShared];
    getShared(shared, path.sample, x);
    for (int k = 0; k < shared.count(); ++k) {
      const float drawn = std::exchange(x[k], border);
      placed.push_back(path);
      setShared(shared, x, placed.back().sample);
      x[k] = drawn;
    }
    std::fill_n(x, shared.count(), border);
    setShared(shared, x, all.sample);
    placed.push_back(all);
    std::fill_n(all.sample.choice.begin(), choices, border);
    placed.push_back(all);
  }
  return placed;
}

ErrorSpread spreadOf(const std::vector<SampledPath>& paths,
                     const std::vector<PathFinding>& findings, float FormCheck::*error) {
  std::vector<double> errors;
  ErrorSpread spread;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const PathFinding& f = findings[i];
    if (!f.compared || f.errors.verdict == FormVerdict::kNotFinite) continue;
    errors.push_back(static_cast<double>(f.errors.*error));
    if (errors.size() > 1 && errors.back() <= spread.worst) continue;
    spread.worst = errors.back();
    spread.replay = pathText(paths[i].technique, paths[i].sample);
  }
  if (errors.empty()) return spread;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  spread.median = *middle;
  return spread;
}

}  // namespace

StressFindings stressScene(const Scene& scene, const StressSettings& settings) {
  StressFindings result;
  const auto stopped = [&] { return settings.stop && settings.stop->load(); };
  const auto notFinite = [&](long long count, const std::string& first) {
    result.notFinite += count;
    if (result.firstNotFinite.empty()) result.firstNotFinite = first;
  };

  const int fromChains = settings.paths / 2;
  NotFiniteCount inSamples;
  ChainStatistics inChains(1, 1);
  std::vector<SampledPath> paths = sampleBidirectional(
      scene, settings.maxLength, settings.paths - fromChains, settings.seed, &inSamples);
  const std::vector<SampledPath> states =
      sampleChains(scene, settings.maxLength, fromChains, settings.seed, settings.threads,
                   settings.stop, &inChains);
  paths.insert(paths.end(), states.begin(), states.end());
  notFinite(inSamples.count, inSamples.first);
  notFinite(inChains.notFinite.count, inChains.notFinite.first);
  result.chains = inChains.derivatives;
  const bool drawn = settings.placement == CoordinatePlacement::kDrawn;
  if (!drawn)
    paths = atBorder(paths, settings.placement == CoordinatePlacement::kZero ? 0.f : kBelowOne,
                     scene.shared());

  std::vector<PathFinding> findings(paths.size());
  parallelFor(settings.threads, (static_cast<int>(paths.size()) + kBlock - 1) / kBlock, [&](int b) {
    const auto end = std::min(paths.size(), static_cast<std::size_t>(b + 1) * kBlock);
    for (auto i = at(b) * kBlock; i < end && !stopped(); ++i) findings[i] = look(scene, paths[i]);
  });
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const PathFinding& f = findings[i];
    const auto text = [&] { return pathText(paths[i].technique, paths[i].sample); };
    if (!f.finite) notFinite(1, text());
    result.paths += f.traced;
    result.doubleNotFinite += f.traced && !f.compared;
    if (f.fallback && result.fallbacks++ == 0) result.firstFallback = text();
  }
  result.value = spreadOf(paths, findings, &FormCheck::value);
  result.gradient = spreadOf(paths, findings, &FormCheck::gradient);
  result.hessian = spreadOf(paths, findings, &FormCheck::hessian);

  if (drawn && settings.samples > 0 && !stopped()) {
    result.pictures = comparePictures(scene, {settings.maxLength, settings.samples, settings.seed,
                                              settings.threads, settings.stop});
    notFinite(result.pictures.notFinite, result.pictures.firstNotFinite);
    result.chains.computed += result.pictures.derivatives.computed;
    result.chains.notFinite += result.pictures.derivatives.notFinite;
  }
  result.interrupted = stopped();
  return result;
}

}  // namespace h2mc
