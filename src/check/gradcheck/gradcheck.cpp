// SPDX-License-Identifier: MIT
#include "check/gradcheck/gradcheck.h"

#include <algorithm>
#include <cmath>

#include "check/gradcheck/form_check.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/path_vertices.h"
#include "render/path/replay_double.h"
#include "render/scene/kinds.h"

namespace h2mc {
namespace {

// Paths that one task checks: some milliseconds' worth.
constexpr int kBlock = 16;

ad::DerivativeValues exactDerivative(const Scene& scene, const Path& path,
                                     const GradcheckSettings& settings) {
  double u[kMaxCoordinates];
  pathCoordinates(path, u);
  return settings.exact ? settings.exact(scene, path, u) : differentiateInDouble(scene, path, u);
}

// All bits of the materials' BSDFs that the vertices 1 .. count show to where the path came from.
std::uint32_t bsdfBits(const Scene& scene, const std::vector<TracedVertex>& vertices, int count) {
  std::uint32_t bits = 0;
  for (int i = 1; i <= count; ++i) {
    const TracedVertex& v = vertices[at(i)];
    const Bsdf* const bsdf = bsdfSeen(scene, v);
    if (bsdf) bits |= 1u << bsdfKindIndex(*bsdf);
  }
  return bits;
}

}  // namespace

std::string nameOf(const SampledPath& path) {
  switch (path.origin) {
    case PathOrigin::kBidirectional:
      return "bdpt sample " + std::to_string(path.index);
    case PathOrigin::kChain:
      return "chain " + std::to_string(path.index >> 32) + ", state " +
             std::to_string(path.index & 0xffffffffu);
    case PathOrigin::kGiven:
      break;
  }
  return "given";
}

PathTraits traitsOf(const Scene& scene, const Path& path) {
  PathTraits traits;
  const auto [s, t] = path.technique;
  // With s = 0 the last vertex is the light itself, or nothing.
  traits.bsdfs =
      bsdfBits(scene, path.camera, s == 0 ? t - 2 : t - 1) | bsdfBits(scene, path.light, s - 1);
  const int light =
      s == 0 && path.escaped ? scene.environmentAt(path.lastRay.direction) : path.lightIndex;
  if (light >= 0) traits.light = static_cast<int>(scene.lights[at(light)].index());
  traits.moving = path.moving;
  return traits;
}

std::vector<double> largestSteps(const Path& path) {
  constexpr double kLargest = 1.0 / 16;
  std::vector<double> steps(static_cast<std::size_t>(path.dimension()), kLargest);
  double coordinates[kMaxCoordinates];
  pathCoordinates(path, coordinates);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double u = coordinates[i];
    const bool wraps = i < at(path.technique.dimension()) && ((path.wraps >> i) & 1);
    if (!wraps) steps[i] = std::min(kLargest, 0.99 * std::min(u, 1 - u));
  }
  return steps;
}

bool PathCheck::failed() const {
  return verdict == ad::Verdict::kWrong ||
         std::any_of(forms.begin(), forms.end(),
                     [](const FormCheck& f) { return f.verdict == FormVerdict::kWrong; });
}

long long GradcheckResult::failures() const {
  return std::count_if(paths.begin(), paths.end(), [](const PathCheck& p) { return p.failed(); });
}

PathCheck checkPath(const Scene& scene, const SampledPath& sampled,
                    const GradcheckSettings& settings, ad::DerivativeCheck* details) {
  PathCheck result;
  result.path = sampled;
  Path path(std::max(settings.maxLength, sampled.technique.length()));
  path.technique = sampled.technique;
  path.sample = sampled.sample;
  result.traced = tracePath(scene, path);
  if (!result.traced) return result;
  result.traits = traitsOf(scene, path);
  const ad::DerivativeValues exact = exactDerivative(scene, path, settings);
  const ad::PlainFunction f = [&](const double* u) { return replayInDouble(scene, path, u); };
  double u[kMaxCoordinates];
  pathCoordinates(path, u);
  ad::DerivativeCheck check = ad::checkDerivative(f, u, path.dimension(), largestSteps(path).data(),
                                                  exact, settings.tolerance);
  result.finite = check.finite;
  result.verdict = check.verdict();
  result.agree = check.agree;
  result.noisy = check.noisy;
  result.kinked = check.kinked;
  result.wrong = check.wrong;
  result.valueError = check.valueError;
  result.gradientError = check.gradientError;
  result.hessianError = check.hessianError;
  if (exact.finite())
    for (std::size_t k = 0; k < settings.forms.size(); ++k)
      result.forms[k] = checkForm(scene, path, exact, settings.forms[k], settings);
  if (details) *details = std::move(check);
  return result;
}

GradcheckResult gradcheck(const Scene& scene, const GradcheckSettings& settings) {
  const int fromChains = settings.paths / 2;
  std::vector<SampledPath> paths =
      sampleBidirectional(scene, settings.maxLength, settings.paths - fromChains, settings.seed);
  const std::vector<SampledPath> chains = sampleChains(
      scene, settings.maxLength, fromChains, settings.seed, settings.threads, settings.stop);
  paths.insert(paths.end(), chains.begin(), chains.end());

  std::vector<PathCheck> checks(paths.size());
  std::vector<char> done(paths.size(), 0);
  const int blocks = (static_cast<int>(paths.size()) + kBlock - 1) / kBlock;
  std::atomic<long long> count{0};
  const auto stopped = [&] { return settings.stop && settings.stop->load(); };
  parallelFor(settings.threads, blocks, [&](int b) {
    const auto end = std::min(paths.size(), static_cast<std::size_t>(b + 1) * kBlock);
    for (auto i = at(b) * kBlock; i < end && !stopped(); ++i) {
      checks[i] = checkPath(scene, paths[i], settings);
      done[i] = 1;
      ++count;
      if (settings.progress) settings.progress(count, static_cast<long long>(paths.size()));
    }
  });
  GradcheckResult result;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (done[i]) result.paths.push_back(checks[i]);
  result.interrupted = stopped();
  return result;
}

}  // namespace h2mc
