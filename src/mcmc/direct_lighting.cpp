#include "mcmc/direct_lighting.h"

#include <algorithm>
#include <cmath>

#include "render/core/random.h"
#include "render/integrator/path_integrator.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

// The least of it: this share of the time, or one sample for so many mutations, and then no more than
// so many.
constexpr double kLeastOfTime = 0.1;
constexpr long long kMutationsASample = 4, kMostAtFirst = 256;
// The most, whatever the chains seem to need: what they have not found yet makes no noise.
constexpr double kMostOfTime = 0.8;
// Of a mutation, in samples, where the clock must not matter: 1.5 to 4 on the project's scenes.
constexpr double kMutationCost = 2;

// Adds samples with seeds of their own.
void merge(RenderResult& into, const RenderResult& part) {
  const double n0 = static_cast<double>(into.samples), n1 = static_cast<double>(part.samples);
  const bool interrupted = into.interrupted || part.interrupted;
  if (into.samples == 0 || part.samples == 0) {
    if (into.samples == 0) into = part;
    into.interrupted = interrupted;
    return;
  }
  const double n = n0 + n1;
  const float share0 = static_cast<float>(n0 / n), share1 = static_cast<float>(n1 / n);
  for (std::size_t i = 0; i < into.image.pixels.size(); ++i)
    into.image.pixels[i] = into.image.pixels[i] * share0 + part.image.pixels[i] * share1;
  into.meanLuminance = (n0 * into.meanLuminance + n1 * part.meanLuminance) / n;
  into.meanLuminanceError =
      std::hypot(n0 * into.meanLuminanceError, n1 * part.meanLuminanceError) / n;
  into.wallSeconds += part.wallSeconds;
  into.samples += part.samples;
  into.interrupted = interrupted;
  const auto sum = [&](const char* name) {
    return into.statistics.value(name, 0LL) + part.statistics.value(name, 0LL);
  };
  into.statistics = {{"samples", into.samples},
                     {"samples per pixel", sum("samples per pixel")},
                     {"samples per second", n / std::max(into.wallSeconds, 1e-9)},
                     {"not finite", sum("not finite")},
                     {"mean luminance", into.meanLuminance},
                     {"mean luminance standard error", into.meanLuminanceError}};
}

}  // namespace

double samplesAMutation(double perSample, double sampleCost, double perMutation,
                        double mutationCost) {
  const double most = kMostOfTime / (1 - kMostOfTime) * mutationCost / sampleCost;
  if (!(perSample > 0)) return 0;
  if (!(perMutation > 0)) return most;
  return std::min(most, std::sqrt(perSample / perMutation * mutationCost / sampleCost));
}

DirectLighting::DirectLighting(const Scene& scene, const OptionSet& options,
                               const RenderRequest& request)
    : scene_(scene),
      request_(request),
      wanted_(options.integer("directSamples")),
      minDepth_(options.integer("minDepth")) {
  for (RenderResult& half : halves_) half.statistics = nlohmann::json::object();
}

bool DirectLighting::interrupted() const {
  return halves_[0].interrupted || halves_[1].interrupted;
}

Image DirectLighting::image() const { return result().image; }

RenderResult DirectLighting::result() const {
  RenderResult all = halves_[0];
  merge(all, halves_[1]);
  return all;
}

long long DirectLighting::perPixel(int half) const {
  return halves_[static_cast<std::size_t>(half)].statistics.value("samples per pixel", 0LL);
}

long long DirectLighting::perPixel() const { return perPixel(0) + perPixel(1); }

void DirectLighting::add(const RenderBudget& budget) {
  const IntegratorFactory factory = pathIntegrator();
  OptionSet options(factory.plugin);
  options.set("maxDepth", std::to_string(kLongest));
  options.set("minDepth", std::to_string(minDepth_));
  long long samples = budget.samplesPerPixel;
  const long long before = perPixel();
  for (int half = 0; half < 2 && !interrupted(); ++half) {
    RenderRequest own;
    // The first part has the seed that it would have alone.
    own.seed = parts_ == 0 ? request_.seed : mixBits(mixBits(request_.seed) + parts_);
    ++parts_;
    own.threads = request_.threads;
    own.stop = request_.stop;
    own.progress = request_.progress;
    own.budget.seconds = budget.seconds / 2;
    if (samples > 0) {
      own.budget.samplesPerPixel = (before + samples + 1 - half) / 2 - perPixel(half);
      if (own.budget.samplesPerPixel <= 0) continue;
    }
    merge(halves_[static_cast<std::size_t>(half)], factory.create(options)->render(scene_, own));
  }
}

void DirectLighting::extendTo(double renderSeconds, long long mutationsPerPixel) {
  RenderBudget budget;
  // A time budget holds for the whole render: the scene's number of samples is then an upper limit.
  if (renderSeconds > 0) {
    budget.seconds = kLeastOfTime * (renderSeconds - renderSeconds_);
    if (budget.seconds <= 0) return;
    renderSeconds_ = renderSeconds;
  }
  const long long had = perPixel();
  long long samples = 0;  // 0: as many as the time allows
  if (wanted_ > 0)
    samples = wanted_;
  else if (renderSeconds <= 0)
    samples = std::clamp(mutationsPerPixel / kMutationsASample, 1LL, kMostAtFirst);
  if (samples > 0 && samples <= had) return;
  if (samples > 0) budget.samplesPerPixel = samples - had;
  add(budget);
}

void DirectLighting::measure(const TwoEstimates& chains, int cell) {
  TwoEstimates own{halves_[0].image, halves_[1].image, static_cast<double>(perPixel(0)),
                   static_cast<double>(perPixel(1))};
  for (Image* image : {&own.a, &own.b})
    for (Rgbf& pixel : image->pixels) pixel *= static_cast<float>(1 / scene_.radianceUnit);
  const std::vector<double> weights = relativeWeights(own.mean(), chains.mean(), cell);
  perSample_ = varianceOfOneSample(own, weights);
  perMutation_ = varianceOfOneSample(chains, weights);
}

void DirectLighting::balance(const Standing& now) {
  if (wanted_ > 0 || interrupted()) return;
  const auto had = static_cast<double>(perPixel());
  const bool timed = now.endSeconds > 0;
  double sampleCost = 1, mutationCost = kMutationCost;
  if (timed) {
    sampleCost = seconds() / had;
    mutationCost = now.chainSeconds / now.mutations;
    if (!(sampleCost > 0 && mutationCost > 0)) return;
  }
  const double left = timed ? now.endSeconds - now.seconds : now.endMutations - now.mutations;
  if (!(left > 0)) return;
  const double ratio = samplesAMutation(perSample_, sampleCost, perMutation_, mutationCost);
  // What is left of the time buys both in that ratio.
  const double atEnd = timed ? (left + now.mutations * mutationCost + had * sampleCost) /
                                   (mutationCost + ratio * sampleCost)
                             : now.endMutations;
  const double mutations = std::min(atEnd, now.growth * now.mutations);
  RenderBudget budget;
  budget.samplesPerPixel = std::llround(ratio * mutations - had);
  if (budget.samplesPerPixel <= 0) return;
  // Never past the end, should the machine have become slower.
  if (timed) budget.seconds = left;
  add(budget);
}

void DirectLighting::addTo(RenderResult& result) const {
  const RenderResult own = this->result();
  if (result.image.pixels.empty())
    result.image = own.image;
  else
    for (std::size_t i = 0; i < result.image.pixels.size(); ++i)
      result.image.pixels[i] += own.image.pixels[i];
  result.meanLuminance += own.meanLuminance;
  result.meanLuminanceError = std::hypot(result.meanLuminanceError, own.meanLuminanceError);
  result.interrupted |= own.interrupted;
  result.statistics["direct lighting"] = own.statistics;
}

}  // namespace h2mc
