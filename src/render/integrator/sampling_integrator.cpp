// SPDX-License-Identifier: MIT
#include "render/integrator/sampling_integrator.h"

#include <algorithm>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/core/unit_interval.h"
#include "render/integrator/common_options.h"
#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

// Most samples of a round, which is the shortest time that a render can take: 30 ms to 2 s of one core, by the scene
// and the integrator.
constexpr long long kMostARound = 1 << 16;

// A uniform position in pixel number `pixel` of a row or column of `size`, in [0, 1).
float positionIn(int pixel, int size, Random& random) {
  return std::min(kBelowOne,
                  (static_cast<float>(pixel) + random.uniform()) / static_cast<float>(size));
}

int sideFor(const FilmSettings& film) {
  int side = 1;
  while (static_cast<long long>(film.width) * film.height / (side * side) > kMostARound) side *= 2;
  return side;
}

struct Offset {
  int x, y;
};

// Where in a square of side x side pixels, a power of 2, the index-th pixel is, so that those up to any index are
// spread evenly (the order of ordered dithering), all shifted.
Offset inSquare(int index, int side, std::uint64_t shift) {
  auto x = static_cast<int>(shift % at(side)), y = static_cast<int>((shift >> 32) % at(side));
  for (int step = side / 2; step > 0; step /= 2, index /= 4) {
    const int quarter = index & 3;  // (0, 0), (1, 1), (1, 0), (0, 1)
    x += step * ((quarter == 1) | (quarter == 2));
    y += step * ((quarter == 1) | (quarter == 3));
  }
  return {x % side, y % side};
}

RenderResult resultOf(const Scene& scene, const SampledFilm& sampled, const RenderRequest& request,
                      const RenderClock& clock, const RoundsResult& rounds,
                      const SharedByPass& shared) {
  const PixelStatistics& statistics = request.pixelStatistics;
  const int threads = request.threads;
  RenderResult result;
  result.wallSeconds = clock.wallSeconds();
  result.cpuSeconds = clock.cpuSeconds();
  result.interrupted = rounds.interrupted;
  const SampleTally total = sampled.tally(0);
  const double scale = total.samples > 0 ? 1 / static_cast<double>(total.samples) : 0;
  result.image = sampled.film().develop(scale, threads);
  if (statistics.variance) result.variance = sampled.variance(threads);
  if (statistics.counts) result.counts = sampled.counts();
  result.samples = total.samples;
  result.sampleUnit = "samples";
  result.meanLuminance = total.meanLuminance();
  result.meanLuminanceError = sampled.meanLuminanceError();
  finish(scene, result);
  result.statistics = sampleStatistics(scene, total, result.wallSeconds);
  result.statistics["mean luminance standard error"] = result.meanLuminanceError;
  if (shared.addStatistics) shared.addStatistics(result.statistics);
  return result;
}

}  // namespace

nlohmann::json sampleStatistics(const Scene& scene, const SampleTally& tally, double seconds) {
  const long long pixels = static_cast<long long>(scene.film.width) * scene.film.height;
  const double samples = static_cast<double>(tally.samples);
  nlohmann::json statistics = {
      {"samples", tally.samples},
      {"samples per second", samples / std::max(seconds, 1e-9)},
      {"not finite", tally.notFinite},
      {"mean luminance", tally.meanLuminance() * scene.radianceUnit},
      {"mean luminance standard error", tally.meanLuminanceError() * scene.radianceUnit}};
  if (tally.samples % pixels == 0)
    statistics["samples per pixel"] = tally.samples / pixels;
  else
    statistics["samples per pixel"] = samples / static_cast<double>(pixels);
  return statistics;
}

SampledFilm::SampledFilm(const Scene& scene, const MakeSampler& makeSampler, int step,
                         PixelStatistics statistics, const SharedByPass& shared)
    : scene_(scene), side_(sideFor(scene.film)), film_(scene.film, step), beginPass_(shared.begin) {
  const long long pixels = static_cast<long long>(scene.film.width) * scene.film.height;
  if (statistics.variance) even_.emplace(scene.film);
  if (statistics.counts) counts_.resize(static_cast<std::size_t>(pixels));
  groups_.resize(at(groupCount(pixels / roundsAPass())));
  for (Group& group : groups_) group.sampler = makeSampler();
}

SampleTally SampledFilm::tally(int half) const {
  SampleTally total;
  for (const Group& group : groups_) total.add(group.tally[half]);
  return total;
}

// With one pass, that of independent samples is the best guess.
double SampledFilm::meanLuminanceError() const {
  return passes_.passes < 2 ? tally(0).meanLuminanceError() : passes_.error();
}

// Consecutive ones of the round's pixels.
template <class Visit>
void SampledFilm::forEachPixel(int index, long long round, std::uint64_t seed,
                               const Visit& visit) const {
  const int width = scene_.film.width, height = scene_.film.height;
  const int inPass = static_cast<int>(round % roundsAPass());
  const auto pass = static_cast<std::uint64_t>(round / roundsAPass());
  // Of each square its own pixel, drawn anew in each pass: all pixels are as likely after any round.
  const std::uint64_t shifts = mixBits(mixBits(seed) + pass);
  const long long columns = (width + side_ - 1) / side_;
  const long long squares = columns * ((height + side_ - 1) / side_);
  const auto count = static_cast<long long>(groups_.size());
  for (long long i = index * squares / count; i < (index + 1) * squares / count; ++i) {
    const Offset offset = inSquare(inPass, side_, mixBits(shifts ^ static_cast<std::uint64_t>(i)));
    const int x = offset.x + side_ * static_cast<int>(i % columns);
    const int y = offset.y + side_ * static_cast<int>(i / columns);
    if (x < width && y < height) visit(x, y, pass);
  }
}

void SampledFilm::sample(int index, long long round, std::uint64_t seed, int half) {
  Group& group = groups_[at(index)];
  SampleTally& tally = group.tally[half];
  const int width = scene_.film.width, height = scene_.film.height;
  forEachPixel(index, round, seed, [&](int x, int y, std::uint64_t pass) {
    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width) +
                       static_cast<std::uint64_t>(x);
    Random random(seed, pixel, pass);
    const float filmX = positionIn(x, width, random), filmY = positionIn(y, height, random);
    const double added = group.sampler->sample(scene_, random, filmX, filmY, group.splats, tally);
    tally.luminance += added;
    tally.squares += added * added;
    ++tally.samples;
    if (pass % 2 == 0) ++group.inEven;
    if (!counts_.empty()) ++counts_[pixel];
  });
}

void SampledFilm::gather(const RenderRequest& request, long long round) {
  const auto count = static_cast<int>(groups_.size());
  const Share own = shareOf(request.ranks, count);
  const auto landed = [&](int group, std::uint32_t one) {
    if (counts_.empty()) return;
    forEachPixel(group, round, request.seed, [&](int x, int y, std::uint64_t) {
      counts_[at(y) * at(scene_.film.width) + at(x)] += one;
    });
  };
  try {
    exchange(request.ranks, count, [&](Archive& archive, int g) {
      Group& group = groups_[at(g)];
      archive(group.splats, group.tally[0], group.tally[1], group.inEven);
    });
  } catch (const RankLost&) {
    for (int g = own.begin; g < own.end; ++g) {
      Group& group = groups_[at(g)];
      static_cast<Counts&>(group) = group.before;
      landed(g, ~std::uint32_t{0});  // one less
    }
    throw;
  }
  const int bands = bandCount(request.threads, film_.height());
  parallelFor(request.threads, count, [&](int g) {
    Group& group = groups_[at(g)];
    group.before = group;
    if (own.has(g)) return;
    landed(g, 1);
    group.splats.sort(film_, bands);
  });
}

void SampledFilm::archive(Archive& archive) {
  archive(film_);
  for (Group& group : groups_) {
    archive(group.tally[0], group.tally[1], group.inEven);
    group.before = group;
  }
  if (even_) archive(*even_);
  if (beginPass_) archive(passes_);
  const std::size_t pixels = counts_.size();
  archive(counts_);
  if (counts_.size() != pixels) throw ArchiveError("it has another number of pixels");
}

// The picture is the mean of the even passes' and the odd passes', a and b, each by its share of the samples. Where
// one sample has variance v, a - b has v / n_a + v / n_b, and the picture v / (n_a + n_b).
Image SampledFilm::variance(int threads) const {
  long long even = 0;
  for (const Group& group : groups_) even += group.inEven;
  const long long all = tally(0).samples + tally(1).samples, odd = all - even;
  Image result(film_.width(), film_.height());
  if (all == 0) return result;
  const auto scale = [](long long samples) { return 1 / static_cast<double>(samples); };
  const auto share = static_cast<float>(static_cast<double>(even) * static_cast<double>(odd) *
                                        squared(scale(all)));
  parallelFor(threads, result.height, [&](int y) {
    for (int x = 0; x < result.width; ++x) {
      if (even == 0 || odd == 0) {
        result.at(x, y) = squared(film_.pixel(x, y, scale(all)));
        continue;
      }
      const Rgbf inEven = even_->pixel(x, y, scale(even) + scale(odd));
      result.at(x, y) = share * squared(inEven - film_.pixel(x, y, scale(odd)));
    }
  });
  return result;
}

RoundsResult SampledFilm::add(const RenderRequest& request, const RenderClock& clock,
                              RoundsPlan plan, int half) {
  const int bands = bandCount(request.threads, film_.height());
  plan.roundsAPass = roundsAPass();
  plan.stopsInPass = true;
  std::vector<FilmPart> parts;
  for (Group& group : groups_) parts.push_back({&group.splats, half});
  long long round = plan.begin;
  plan.endOfRound = [&] {
    if (request.ranks) gather(request, round);
    if (even_ && round / roundsAPass() % 2 == 0) addKeeping<double>(parts, request.threads, *even_);
    ++round;
    addInOrder<double>(parts, request.threads, film_);
    if (beginPass_ && round % roundsAPass() == 0)
      passes_.end(tally(0), static_cast<double>(film_.width()) * film_.height());
  };
  if (beginPass_) {
    beginPass_(round / roundsAPass());
    // Of what runRounds calls this before, the pass of the first has begun already.
    plan.betweenRounds = [&, first = round] {
      if (round != first && round % roundsAPass() == 0) beginPass_(round / roundsAPass());
    };
  }
  return runRounds(request, clock, static_cast<int>(groups_.size()), plan,
                   [&](int group, long long round) {
                     sample(group, round, request.seed, half);
                     groups_[at(group)].splats.sort(film_, bands);
                   });
}

namespace {

// A render by samples, between two rounds.
class SamplesInProgress final : public RenderInProgress {
 public:
  SamplesInProgress(const Scene& scene, SampledFilm& sampled, const RenderRequest& request,
                    RenderClock& clock, const SharedByPass& shared)
      : scene_(scene), sampled_(sampled), request_(request), clock_(clock), shared_(shared) {}

  void setStanding(const RoundsResult& rounds, bool over) {
    rounds_ = rounds;
    over_ = over;
  }
  RenderResult result() const override {
    return resultOf(scene_, sampled_, request_, clock_, rounds_, shared_);
  }
  bool isExact() const override { return true; }
  bool isOver() const override { return over_; }
  void pause(const std::function<void()>& work) override { clock_.exclude(work); }
  void save(Archive& archive) override {
    double wall = clock_.wallSeconds(), cpu = clock_.cpuSeconds();
    archive(wall, cpu, rounds_.rounds, sampled_);
  }
  // Returns how many rounds were made.
  long long resume(Archive& archive) {
    double wall = 0, cpu = 0;
    archive(wall, cpu, rounds_.rounds, sampled_);
    clock_.advance(wall, cpu);
    return rounds_.rounds;
  }

 private:
  const Scene& scene_;
  SampledFilm& sampled_;
  const RenderRequest& request_;
  RenderClock& clock_;
  const SharedByPass& shared_;
  RoundsResult rounds_;
  bool over_ = false;
};

}  // namespace

RenderResult renderSamples(const Scene& scene, const RenderRequest& request,
                           int defaultSamplesPerPixel, const MakeSampler& makeSampler,
                           const SharedByPass& shared) {
  // The film, the image that becomes of it, and what of a round waits to be added.
  const PixelStatistics& statistics = request.pixelStatistics;
  const double bytesAPixel = 24 + sizeof(Rgbf) + (statistics.variance ? 24 + sizeof(Rgbf) : 0) +
                             (statistics.counts ? sizeof(std::uint32_t) + sizeof(float) : 0);
  requireMemory({filmMemory(scene.film, bytesAPixel),
                 {kMostARound * 48.0, "samples of a round", ""},
                 shared.memory});
  RenderClock clock;
  SampledFilm sampled(scene, makeSampler, 0, statistics, shared);
  RoundsPlan plan;
  plan.seconds = request.budget.seconds;
  // A sample is what a mutation is compared with.
  long long passes = request.budget.samplesPerPixel + request.budget.mutationsPerPixel;
  if (plan.seconds <= 0 && passes == 0) passes = defaultSamplesPerPixel;
  plan.rounds = passes * sampled.roundsAPass();
  plan.unitsPerRound = static_cast<double>(scene.film.width) * scene.film.height /
                       static_cast<double>(sampled.roundsAPass());
  plan.unit = "samples";
  plan.marks = request.marks;
  if (plan.seconds <= 0)
    for (double& mark : plan.marks) mark *= static_cast<double>(sampled.roundsAPass());
  plan.atMark = [&](std::size_t mark, const RoundsResult& rounds) {
    clock.exclude(
        [&] { request.atMark(mark, resultOf(scene, sampled, request, clock, rounds, shared)); });
  };
  SamplesInProgress progress(scene, sampled, request, clock, shared);
  if (request.resume) plan.begin = progress.resume(*request.resume);
  const auto watch = [&](const RoundsResult& rounds, bool over) {
    progress.setStanding(rounds, over);
    request.watch(progress);
  };
  if (request.watch) plan.watch = [&](long long rounds) { watch({rounds, false}, false); };
  const RoundsResult rounds = sampled.add(request, clock, plan);
  if (request.watch) watch(rounds, true);
  return resultOf(scene, sampled, request, clock, rounds, shared);
}

}  // namespace h2mc
