// SPDX-License-Identifier: MIT
#include "mcmc/render/direct_lighting.h"

#include <algorithm>
#include <cmath>

#include "render/core/index.h"
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

// The picture of n0 samples becomes that of n samples with what is to be added to n0 / n of it.
template <class Added>
void mix(Image& image, int width, int height, double n0, double n, const Added& added) {
  if (image.pixels.empty()) image = Image(width, height);
  const auto share = static_cast<float>(n0 / n);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = image.at(x, y) * share + added(x, y);
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
      minDepth_(options.integer("minDepth")),
      longest_(std::min(kLongest, maxPathLength(options))),
      step_(measuredRows(scene.film)) {}

SampleTally DirectLighting::tally() const {
  SampleTally all = halves_[0].tally;
  all.add(halves_[1].tally);
  return all;
}

double DirectLighting::perPixel(const SampleTally& tally) const {
  return static_cast<double>(tally.samples) /
         (static_cast<double>(scene_.film.width) * scene_.film.height);
}

void DirectLighting::add(double seconds, long long samples) {
  const double began = wallClock();
  SampledFilm part(
      scene_,
      [&] {
        return makePathSampler({minDepth_, longest_});
      },
      step_);
  for (int half = 0; half < 2 && !interrupted_; ++half) {
    RoundsPlan plan;
    plan.seconds = seconds / 2;
    plan.unit = "samples";
    plan.unitsPerRound = static_cast<double>(scene_.film.width) * scene_.film.height /
                         static_cast<double>(part.roundsAPass());
    if (samples > 0) {
      const long long wanted = (samples + 1 - half) / 2;  // of half 0 the larger part
      const double passes =
          std::ceil(static_cast<double>(wanted) - perPixel(halves_[at(half)].tally));
      if (!(passes > 0)) continue;
      plan.rounds = std::llround(passes) * part.roundsAPass();
    }
    RenderRequest own;
    // The first part has the seed that it would have alone.
    own.seed = parts_ == 0 ? request_.seed : mixBits(mixBits(request_.seed) + parts_);
    ++parts_;
    own.threads = request_.threads;
    own.stop = request_.stop;
    own.progress = request_.progress;
    interrupted_ = part.add(own, RenderClock(), plan, half).interrupted;
  }
  const double had = static_cast<double>(tally().samples);
  for (int half = 0; half < 2; ++half) {
    Half& own = halves_[at(half)];
    const double before = static_cast<double>(own.tally.samples);
    own.tally.add(part.tally(half));
    const double now = static_cast<double>(own.tally.samples);
    if (!(now > before)) continue;
    const Image rows = part.film().developHalf(half, 1 / now);
    mix(own.rows, rows.width, rows.height, before, now,
        [&](int x, int y) { return rows.at(x, y); });
  }
  const double all = static_cast<double>(tally().samples);
  if (all > had)
    mix(image_, scene_.film.width, scene_.film.height, had, all,
        [&](int x, int y) { return part.film().pixel(x, y, 1 / all); });
  seconds_ += wallClock() - began;
}

void DirectLighting::extendTo(double renderSeconds, long long mutationsPerPixel) {
  double seconds = 0;
  // A time budget holds for the whole render: the scene's number of samples is then an upper limit.
  if (renderSeconds > 0) {
    seconds = kLeastOfTime * (renderSeconds - renderSeconds_);
    if (seconds <= 0) return;
    renderSeconds_ = renderSeconds;
  }
  long long samples = 0;  // 0: as many as the time allows
  if (wanted_ > 0)
    samples = wanted_;
  else if (renderSeconds <= 0)
    samples = std::clamp(mutationsPerPixel / kMutationsASample, 1LL, kMostAtFirst);
  if (samples > 0 && static_cast<double>(samples) <= perPixel(tally())) return;
  add(seconds, samples);
}

void DirectLighting::measure(const TwoEstimates& chains, int cell) {
  const TwoEstimates own{halves_[0].rows, halves_[1].rows, perPixel(halves_[0].tally),
                         perPixel(halves_[1].tally)};
  const std::vector<double> weights =
      relativeWeights(own.mean(), chains.mean(), cell, std::max(1, cell / step_));
  perSample_ = varianceOfOneSample(own, weights);
  perMutation_ = varianceOfOneSample(chains, weights);
}

void DirectLighting::balance(const Standing& now) {
  if (wanted_ > 0 || interrupted_) return;
  const double had = perPixel(tally());
  const bool timed = now.endSeconds > 0;
  double sampleCost = 1, mutationCost = kMutationCost;
  if (timed) {
    sampleCost = seconds_ / had;
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
  const long long samples = std::llround(ratio * mutations);
  if (static_cast<double>(samples) <= had) return;
  // Never past the end, should the machine have become slower.
  add(timed ? left : 0, samples);
}

void DirectLighting::addTo(RenderResult& result) const {
  if (result.image.pixels.empty()) result.image = Image(scene_.film.width, scene_.film.height);
  for (std::size_t i = 0; i < image_.pixels.size(); ++i) result.image.pixels[i] += image_.pixels[i];
  const SampleTally all = tally();
  result.meanLuminance += all.meanLuminance();
  result.meanLuminanceError = std::hypot(result.meanLuminanceError, all.meanLuminanceError());
  result.interrupted |= interrupted_;
  result.statistics["direct lighting"] = sampleStatistics(scene_, all, seconds_);
}

}  // namespace h2mc
