// SPDX-License-Identifier: MIT
#include "mcmc/render/direct_lighting.h"

#include <algorithm>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/core/random.h"
#include "render/integrator/path_integrator.h"
#include "render/integrator/ranks.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

// The least of it: this share of the time, or one sample for so many mutations, and then no more than
// so many.
constexpr double kLeastOfTime = 0.1;
constexpr long long kMutationsASample = 4, kMostAtFirst = 256;
constexpr long long kLeastAtFirst = 2;  // one for either half
// Of a mutation, in samples, where the clock must not matter: 1.5 to 4 on the project's scenes.
constexpr double kMutationCost = 2;

// The picture of n0 samples becomes that of n samples with what is to be added to n0 / n of it.
template <class Added>
void mix(Image& image, int width, int height, int threads, double n0, double n,
         const Added& added) {
  if (image.pixels.empty()) image = Image(width, height);
  const auto share = static_cast<float>(n0 / n);
  parallelFor(threads, height, [&](int y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = image.at(x, y) * share + added(x, y);
  });
}

}  // namespace

DirectLighting::DirectLighting(const Scene& scene, const OptionSet& options,
                               const RenderRequest& request)
    : scene_(scene),
      request_(request),
      wanted_(options.integer("directSamples")),
      minDepth_(options.integer("minDepth")),
      longest_(std::min(longest(scene), maxPathLength(options))),
      step_(measuredRows(scene.film)) {}

SampleTally DirectLighting::tally(const std::array<Half, 2>& halves) {
  SampleTally all = halves[0].tally;
  all.add(halves[1].tally);
  return all;
}

double DirectLighting::perPixel(const SampleTally& tally) const {
  return static_cast<double>(tally.samples) /
         (static_cast<double>(scene_.film.width) * scene_.film.height);
}

std::unique_ptr<SampledFilm> DirectLighting::makeFilm() const {
  return std::make_unique<SampledFilm>(
      scene_,
      [minDepth = minDepth_, longest = longest_] {
        return makePathSampler({minDepth, longest});
      },
      step_);
}

void DirectLighting::add(double seconds, long long samples) {
  part_.emplace();
  part_->seconds = seconds;
  part_->samples = samples;
  part_->film = makeFilm();
  finishPart();
}

void DirectLighting::finishPart() {
  if (!part_) return;
  Part& part = *part_;
  for (; part.half < 2 && !interrupted_; ++part.half, part.begun = false) {
    addHalf(part);
    if (part.half == 0 && request_.pixelStatistics.variance)
      part.first = part.film->film().develop(1, request_.threads);
  }
  const double began = wallClock();
  sums_ = with(std::move(sums_), part);
  seconds_ += part.allSeconds + wallClock() - began;
  part_.reset();
}

void DirectLighting::addHalf(Part& part) {
  const Half& half = sums_.halves[at(part.half)];
  RoundsPlan plan;
  plan.seconds = part.seconds / 2;
  plan.unit = "samples";
  plan.unitsPerRound = static_cast<double>(scene_.film.width) * scene_.film.height /
                       static_cast<double>(part.film->roundsAPass());
  if (part.samples > 0) {
    const long long wanted = (part.samples + 1 - part.half) / 2;  // of half 0 the larger part
    const double passes = std::ceil(static_cast<double>(wanted) - perPixel(half.tally));
    if (!(passes > 0)) return;
    plan.rounds = std::llround(passes) * part.film->roundsAPass();
  }
  if (!part.begun) {
    // The first part has the seed that it would have alone.
    part.seed = parts_ == 0 ? request_.seed : mixBits(mixBits(request_.seed) + parts_);
    ++parts_;
    part.begun = true;
    part.rounds = 0;
    part.halfSeconds = 0;
  }
  RenderRequest own;
  own.seed = part.seed;
  own.threads = request_.threads;
  own.stop = request_.stop;
  own.progress = request_.progress;
  own.ranks = request_.ranks;
  plan.begin = part.rounds;
  RenderClock clock;
  clock.advance(part.halfSeconds, 0);
  partClock_ = &clock;
  const double before = part.allSeconds - part.halfSeconds;
  const auto look = [&] {
    part.halfSeconds = clock.wallSeconds();
    part.allSeconds = before + part.halfSeconds;
  };
  plan.watch = [&](long long rounds) {
    part.rounds = rounds;
    look();
    if (watch_) watch_();
  };
  interrupted_ = part.film->add(own, clock, plan, part.half).interrupted;
  look();
  partClock_ = nullptr;
}

void DirectLighting::pause(const std::function<void()>& work) {
  if (partClock_)
    partClock_->exclude(work);
  else
    work();
}

DirectLighting::Sums DirectLighting::with(Sums sums, const Part& part) const {
  const double had = static_cast<double>(tally(sums.halves).samples);
  for (int half = 0; half < 2; ++half) {
    Half& own = sums.halves[at(half)];
    const double before = static_cast<double>(own.tally.samples);
    own.tally.add(part.film->tally(half));
    const double now = static_cast<double>(own.tally.samples);
    if (!(now > before)) continue;
    const Image rows = part.film->film().developHalf(half, 1 / now);
    mix(own.rows, rows.width, rows.height, request_.threads, before, now,
        [&](int x, int y) { return rows.at(x, y); });
    if (half == 0 && request_.pixelStatistics.variance)
      mix(sums.first, scene_.film.width, scene_.film.height, request_.threads, before, now,
          [&](int x, int y) {
            return part.half == 0 ? part.film->film().pixel(x, y, 1 / now)
                                  : part.first.at(x, y) * static_cast<float>(1 / now);
          });
  }
  const double all = static_cast<double>(tally(sums.halves).samples);
  if (all > had)
    mix(sums.image, scene_.film.width, scene_.film.height, request_.threads, had, all,
        [&](int x, int y) { return part.film->film().pixel(x, y, 1 / all); });
  return sums;
}

// The picture is (n_0 a + n_1 b) / n, and v / n its variance where that of a - b is v / n_0 + v / n_1.
Image DirectLighting::variance(const Sums& sums) const {
  Image result = sums.image;
  const double all = static_cast<double>(tally(sums.halves).samples);
  const double first = static_cast<double>(sums.halves[0].tally.samples);
  if (!(all > 0)) return result;
  const auto weight = static_cast<float>(first / (all - first));  // of (a - picture)^2
  const bool both = first > 0 && first < all;
  parallelFor(request_.threads, result.height, [&](int y) {
    for (int x = 0; x < result.width; ++x) {
      Rgbf& pixel = result.at(x, y);
      pixel = both ? weight * squared(sums.first.at(x, y) - pixel) : squared(pixel);
    }
  });
  return result;
}

void DirectLighting::archive(Archive& archive) {
  archive(renderSeconds_, perSample_, perMutation_, parts_, sums_.halves, sums_.image, seconds_);
  if (request_.pixelStatistics.variance) archive(sums_.first);
  bool under = part_.has_value();
  archive(under);
  if (!under) return;
  if (archive.reading()) {
    part_.emplace();
    part_->film = makeFilm();
  }
  Part& part = *part_;
  archive(part.seconds, part.samples, part.half, part.begun, part.seed, part.rounds,
          part.halfSeconds, part.allSeconds, *part.film);
  if (request_.pixelStatistics.variance) archive(part.first);
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
    samples = std::clamp(mutationsPerPixel / kMutationsASample, kLeastAtFirst, kMostAtFirst);
  if (samples > 0 && static_cast<double>(samples) <= perPixel(tally())) return;
  add(seconds, samples);
}

TwoEstimates DirectLighting::ownRows() const {
  return {sums_.halves[0].rows, sums_.halves[1].rows, perPixel(sums_.halves[0].tally),
          perPixel(sums_.halves[1].tally)};
}

std::vector<double> DirectLighting::weights(const Image& chains, int cell) const {
  const Image own = wanted() ? ownRows().mean() : Image(chains.width, chains.height);
  return relativeWeights(own, chains, cell, std::max(1, cell / step_));
}

double DirectLighting::noise() const {
  const double had = perPixel(tally());
  return had > 0 ? perSample_ / had : 0;
}

void DirectLighting::measure(const TwoEstimates& chains, const std::vector<double>& weights) {
  perSample_ = varianceOfOneSample(ownRows(), weights);
  perMutation_ = varianceOfOneSample(chains, weights);
}

void DirectLighting::balance(const Standing& now) {
  if (wanted_ > 0 || interrupted_) return;
  const double had = perPixel(tally());
  const bool timed = now.endSeconds > 0;
  double sampleCost = 1, mutationCost = kMutationCost * now.mutationCost;
  if (timed) {
    sampleCost = agreed(request_.ranks, seconds_) / had;
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
  const Sums more = part_ ? with(sums_, *part_) : Sums();
  const Sums& sums = part_ ? more : sums_;
  for (std::size_t i = 0; i < sums.image.pixels.size(); ++i)
    result.image.pixels[i] += sums.image.pixels[i];
  if (request_.pixelStatistics.variance && !sums.image.pixels.empty()) {
    const Image own = variance(sums);
    if (result.variance.pixels.empty()) result.variance = Image(own.width, own.height);
    for (std::size_t i = 0; i < own.pixels.size(); ++i) result.variance.pixels[i] += own.pixels[i];
  }
  const SampleTally all = tally(sums.halves);
  result.meanLuminance += all.meanLuminance();
  result.meanLuminanceError = std::hypot(result.meanLuminanceError, all.meanLuminanceError());
  result.interrupted |= interrupted_;
  result.statistics["direct lighting"] =
      sampleStatistics(scene_, all, seconds_ + (part_ ? part_->allSeconds : 0));
  result.statistics["noise"]["direct lighting"] = noise();
}

}  // namespace h2mc
