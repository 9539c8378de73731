#include "render/integrator/sampling_integrator.h"

#include <cmath>

#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// A uniform position in pixel number `pixel` of a row or column of `size`, in [0, 1).
float positionIn(int pixel, int size, Random& random) {
  return std::min(kBelowOne,
                  (static_cast<float>(pixel) + random.uniform()) / static_cast<float>(size));
}

struct Group {
  Film film;
  std::unique_ptr<PixelSampler> sampler;
  SampleTally tally;
};

// What the groups have so far; leaves them as they are.
RenderResult resultOf(const Scene& scene, const std::vector<Group>& work, const RenderClock& clock,
                      const RoundsResult& rounds) {
  RenderResult result;
  result.wallSeconds = clock.wallSeconds();
  result.cpuSeconds = clock.cpuSeconds();
  result.interrupted = rounds.interrupted;
  SampleTally total;
  Film film(scene.film);
  for (const Group& group : work) {
    total.luminance += group.tally.luminance;
    total.squares += group.tally.squares;
    total.samples += group.tally.samples;
    total.notFinite += group.tally.notFinite;
    film.merge(group.film);
  }
  const double n = static_cast<double>(total.samples);
  result.image = film.develop(n > 0 ? 1 / n : 0);
  result.samples = total.samples;
  result.sampleUnit = "samples";
  if (n > 0) {
    result.meanLuminance = total.luminance / n;
    result.meanLuminanceError = std::sqrt(
        std::max(0.0, total.squares / n - result.meanLuminance * result.meanLuminance) / n);
  }
  toFileUnits(scene, result);
  result.statistics = {{"samples", total.samples},
                       {"samples per pixel", rounds.rounds},
                       {"samples per second", n / std::max(result.wallSeconds, 1e-9)},
                       {"not finite", total.notFinite},
                       {"mean luminance", result.meanLuminance},
                       {"mean luminance standard error", result.meanLuminanceError}};
  return result;
}

}  // namespace

RenderResult renderSamples(const Scene& scene, const RenderRequest& request,
                           int defaultSamplesPerPixel,
                           const std::function<std::unique_ptr<PixelSampler>()>& makeSampler) {
  RenderClock clock;
  const int width = scene.film.width, height = scene.film.height;
  const int groups = groupCount(scene.film);
  std::vector<Group> work;
  work.reserve(static_cast<std::size_t>(groups));
  for (int i = 0; i < groups; ++i) work.push_back({Film(scene.film), makeSampler(), {}});

  RoundsPlan plan;
  plan.seconds = request.budget.seconds;
  // A sample is what a mutation is compared with.
  plan.rounds = request.budget.samplesPerPixel + request.budget.mutationsPerPixel;
  if (plan.seconds <= 0 && plan.rounds == 0) plan.rounds = defaultSamplesPerPixel;
  plan.unitsPerRound = static_cast<double>(width) * height;
  plan.unit = "samples";
  plan.marks = request.marks;
  plan.atMark = [&](std::size_t mark, const RoundsResult& rounds) {
    clock.exclude([&] { request.atMark(mark, resultOf(scene, work, clock, rounds)); });
  };

  const RoundsResult rounds =
      runRounds(request, clock, groups, plan, [&](int index, long long round) {
        Group& group = work[static_cast<std::size_t>(index)];
        SampleTally& tally = group.tally;
        for (int y = index; y < height; y += groups) {
          for (int x = 0; x < width; ++x) {
            const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width) +
                               static_cast<std::uint64_t>(x);
            Random random(request.seed, pixel, static_cast<std::uint64_t>(round));
            const float filmX = positionIn(x, width, random), filmY = positionIn(y, height, random);
            const double added =
                group.sampler->sample(scene, random, filmX, filmY, group.film, tally);
            tally.luminance += added;
            tally.squares += added * added;
            ++tally.samples;
          }
        }
      });

  return resultOf(scene, work, clock, rounds);
}

}  // namespace h2mc
