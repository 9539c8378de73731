// SPDX-License-Identifier: MIT
#include "mcmc/mutations/langevin_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcmc/chain/statistics.h"
#include "mcmc/mutations/mutation_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Longer paths have the prior: there are too many techniques, each too seldom met.
constexpr int kLongest = 12;
// The sums of a technique, with or without time: how many gradients, then the squares of its coordinates.
constexpr int kStride = 1 + 2 * kLongest + kMostShared;
// So many gradients are asked for before their mean is believed.
constexpr double kLeast = 64;
// Squares count no further than this: a mean of fewer than a thousand must not hang on one of them.
constexpr double kMostSquare = 1e6;

// The authors' longest gradient.
constexpr float kLongestGradient = 100;
void shorten(Gradient& gradient) {
  float squares = 0;
  for (int i = 0; i < gradient.dimension; ++i) squares += squared(gradient.gradient[i]);
  if (!(squares > squared(kLongestGradient))) return;
  const float factor = kLongestGradient / std::sqrt(squares);
  for (int i = 0; i < gradient.dimension; ++i) gradient.gradient[i] *= factor;
}

std::size_t placeOf(const Path& path) {
  const int length = path.technique.length();
  return at((2 * (length * (length + 1) / 2 + path.technique.s) + path.moving) * kStride);
}

}  // namespace

void GradientSquares::add(const Path& path, const Gradient& gradient, std::vector<double>& sums) {
  if (path.technique.length() > kLongest) return;
  const std::size_t place = placeOf(path);
  if (sums.size() < place + kStride) sums.resize(place + kStride, 0);
  sums[place] += 1;
  for (int i = 0; i < gradient.dimension; ++i)
    sums[place + 1 + at(i)] += std::min(squared(double(gradient.gradient[i])), kMostSquare);
}

void GradientSquares::learn(const std::vector<double>& sums) {
  means_.assign(sums.size(), 0);
  for (std::size_t place = 0; place < sums.size(); place += kStride) {
    if (sums[place] < kLeast) continue;
    means_[place] = 1;
    for (std::size_t i = place + 1; i < place + kStride; ++i)
      means_[i] = static_cast<float>(sums[i] / sums[place]);
  }
}

const float* GradientSquares::of(const Path& path) const {
  if (path.technique.length() > kLongest) return nullptr;
  const std::size_t place = placeOf(path);
  return place < means_.size() && means_[place] > 0 ? &means_[place + 1] : nullptr;
}

void LangevinStep::learn(const ChainStatistics& statistics, std::size_t kind) {
  squares_.learn(statistics.sums[kind]);
  sizes_.learn(statistics.acceptance[kind]);
}

void LangevinStep::make(const Path& path, MutationContext& context, Gaussian& gaussian) const {
  isotropicGaussian(path.dimension(), sigma(), gaussian);
  const double start = context.timed ? wallClock() : 0;
  Gradient gradient;
  target().differentiateOnce(path, gradient);
  if (context.timed) context.seconds.derivatives += wallClock() - start;
  if (!gradient.finite()) {
    ++context.derivatives.notFinite;
    return;
  }
  if (settings_.published) shorten(gradient);
  if (context.sums) GradientSquares::add(path, gradient, *context.sums);
  const float* const squares = squares_.of(path);
  const float size2 = squared(sizes_.of(path.technique.length()));
  gaussian.logNormalisation = 0;
  for (int i = 0; i < gaussian.dimension; ++i) {
    const float g = gradient.gradient[i];
    const float* const square = squares ? squares + i : nullptr;
    const Law law =
        settings_.published ? publishedLawOf(g, square, size2) : lawOf(g, square, size2);
    const float deviation = std::sqrt(law.variance), longest = settings_.maxDrift * deviation;
    gaussian.deviation[i] = deviation;
    gaussian.mean[i] = std::clamp(law.drift, -longest, longest);
    gaussian.logNormalisation -= std::log(double(deviation));
  }
}

LangevinStep::Law LangevinStep::lawOf(float g, const float* square, float size2) const {
  const float prior = 1 / squared(sigma()), curvature = 1 / squared(settings_.stepSize);
  const float variance = size2 / (prior + curvature * std::max(squared(g), square ? *square : 0));
  return {variance, variance * g / 2};
}

LangevinStep::Law LangevinStep::publishedLawOf(float g, const float* square, float size2) const {
  const float root = square ? std::sqrt(*square) : std::abs(g);
  const float scale = std::clamp(1 / (1e-3f + root), 0.01f, 100.f);
  const float variance =
      size2 / (1 / (squared(settings_.stepSize) * (scale + 1)) + 1 / squared(sigma()));
  return {variance, variance * std::clamp(g, -5.f, 5.f) / 2};
}

MutationPlugin langevinStep() {
  static constexpr Parameter kParameters[] = {
      kSigmaParameter,          kStepSizeParameter, kMaxDriftParameter, kTargetAcceptanceParameter,
      kPreconditionerParameter,
  };
  return {"langevin", "a step drawn from the Gaussian that the gradient gives by Langevin dynamics",
          kParameters,
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            const auto number = [&](const char* name) {
              return static_cast<float>(setup.options.number(name));
            };
            const LangevinStep::Settings settings{
                number("sigma"), number("stepSize"), number("maxDrift"),
                setup.options.number("targetAcceptance"),
                setup.options.string("preconditioner") == "published"};
            return std::make_unique<LangevinStep>(setup.target, settings, setup.slots);
          },
          [](const OptionSet& options) {
            requireRange(options, "sigma", 1e-9, 1);
            requireRange(options, "stepSize", 1e-6, 1e6);
            requireRange(options, "maxDrift", 0, std::numeric_limits<double>::infinity());
            requireAcceptance(options);
          }};
}

}  // namespace h2mc
