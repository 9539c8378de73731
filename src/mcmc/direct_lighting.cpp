#include "mcmc/direct_lighting.h"

#include <algorithm>
#include <cmath>

#include "render/core/random.h"
#include "render/integrator/path_integrator.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

constexpr double kTimeShare = 0.1;
// Of a budget in mutations: one sample for so many mutations, and no more than so many.
constexpr long long kMutationsASample = 4, kMostSamples = 256;

}  // namespace

DirectLighting::DirectLighting(const Scene& scene, const OptionSet& options,
                               const RenderRequest& request)
    : scene_(scene),
      request_(request),
      wanted_(options.integer("directSamples")),
      minDepth_(options.integer("minDepth")) {}

void DirectLighting::extendTo(double renderSeconds, long long mutationsPerPixel) {
  RenderRequest own;
  // The first part has the seed that it would have alone.
  own.seed = parts_ == 0 ? request_.seed : mixBits(mixBits(request_.seed) + parts_);
  own.threads = request_.threads;
  own.stop = request_.stop;
  // A time budget holds for the whole render: the scene's number of samples is then an upper limit.
  if (renderSeconds > 0) {
    own.budget.seconds = kTimeShare * (renderSeconds - seconds_);
    if (own.budget.seconds <= 0) return;
  }
  long long samples = 0;  // 0: as many as the time allows
  if (wanted_ > 0)
    samples = wanted_;
  else if (renderSeconds <= 0)
    samples = std::clamp(mutationsPerPixel / kMutationsASample, 1LL, kMostSamples);
  if (samples > 0 && samples <= perPixel_) return;
  if (samples > 0) own.budget.samplesPerPixel = samples - perPixel_;

  const IntegratorFactory factory = pathIntegrator();
  OptionSet options(factory.plugin);
  options.set("maxDepth", std::to_string(kLongest));
  options.set("minDepth", std::to_string(minDepth_));
  merge(factory.create(options)->render(scene_, own));
  seconds_ = renderSeconds;
  ++parts_;
}

void DirectLighting::merge(const RenderResult& part) {
  const double n0 = static_cast<double>(result_.samples), n1 = static_cast<double>(part.samples);
  perPixel_ += part.statistics.value("samples per pixel", 0LL);
  if (result_.samples == 0 || part.samples == 0) {
    const bool interrupted = result_.interrupted || part.interrupted;
    if (result_.samples == 0) result_ = part;
    result_.interrupted = interrupted;
    return;
  }
  const double n = n0 + n1;
  const float share0 = static_cast<float>(n0 / n), share1 = static_cast<float>(n1 / n);
  for (std::size_t i = 0; i < result_.image.pixels.size(); ++i)
    result_.image.pixels[i] = result_.image.pixels[i] * share0 + part.image.pixels[i] * share1;
  result_.meanLuminance = (n0 * result_.meanLuminance + n1 * part.meanLuminance) / n;
  result_.meanLuminanceError =
      std::hypot(n0 * result_.meanLuminanceError, n1 * part.meanLuminanceError) / n;
  result_.wallSeconds += part.wallSeconds;
  result_.samples += part.samples;
  result_.interrupted |= part.interrupted;
  const long long notFinite = result_.statistics.value("not finite", 0LL);
  result_.statistics = {{"samples", result_.samples},
                        {"samples per pixel", perPixel_},
                        {"samples per second", n / std::max(result_.wallSeconds, 1e-9)},
                        {"not finite", notFinite + part.statistics.value("not finite", 0LL)},
                        {"mean luminance", result_.meanLuminance},
                        {"mean luminance standard error", result_.meanLuminanceError}};
}

void DirectLighting::addTo(RenderResult& result) const {
  if (result.image.pixels.empty())
    result.image = result_.image;
  else
    for (std::size_t i = 0; i < result.image.pixels.size(); ++i)
      result.image.pixels[i] += result_.image.pixels[i];
  result.meanLuminance += result_.meanLuminance;
  result.meanLuminanceError = std::hypot(result.meanLuminanceError, result_.meanLuminanceError);
  result.interrupted |= result_.interrupted;
  result.statistics["direct lighting"] = result_.statistics;
}

}  // namespace h2mc
