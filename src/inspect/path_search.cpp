// SPDX-License-Identifier: MIT
#include "inspect/path_search.h"

#include <algorithm>

#include "render/path/bidirectional.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kSampleStream = 0x696e7370, kChainStream = 0x696e7371;

// A position in the pixel, on the film: never in its neighbour by rounding.
float positionIn(int pixel, int pixels, float u) {
  const float position = (static_cast<float>(pixel) + u) / static_cast<float>(pixels);
  return pixelAt(position, pixels) == pixel
             ? position
             : (static_cast<float>(pixel) + 0.5f) / static_cast<float>(pixels);
}

}  // namespace

int pixelAt(float film, int pixels) {
  return std::clamp(static_cast<int>(film * static_cast<float>(pixels)), 0, pixels - 1);
}

std::vector<Path> findPaths(const SceneTarget& target, KernelMixture& kernels, int minLength,
                            const InspectSettings& settings, std::size_t count,
                            PathSearch& search) {
  const Scene& scene = target.scene();
  const int width = scene.film.width, height = scene.film.height;
  const auto inPixel = [&](float x, float y) {
    return x >= 0 && y >= 0 && pixelAt(x, width) == settings.pixelX &&
           pixelAt(y, height) == settings.pixelY;
  };
  const auto stopped = [&] { return settings.stop && *settings.stop; };

  search = {};
  search.minLength = minLength;
  BidirectionalSampler sampler(target.maxLength());
  Random random(settings.seed, kSampleStream, 0);
  struct Candidate {
    Technique technique;
    PrimarySample sample;
    double target = 0;
  };
  std::vector<Candidate> starts(count);
  Candidate largest;
  double sum = 0;
  for (; search.samples < settings.samples && !stopped(); ++search.samples) {
    const float x = positionIn(settings.pixelX, width, random.uniform());
    const float y = positionIn(settings.pixelY, height, random.uniform());
    sampler.sample(scene, random, x, y, minLength, [&](const BidirectionalSampler::Connection& c) {
      if (!inPixel(c.filmX, c.filmY)) return;
      ++search.contributing;
      const Candidate candidate{c.technique, sampler.primarySample(c.technique), target.of(c)};
      sum += candidate.target;
      for (Candidate& start : starts)
        if (random.uniformDouble() * sum < candidate.target) start = candidate;
      if (candidate.target > largest.target) largest = candidate;
    });
  }
  if (search.contributing == 0) return {};

  const bool wantsLargest = settings.choice == PathChoice::kLargest;
  if (wantsLargest) starts = {largest};
  const long long mutations =
      settings.mutations / static_cast<long long>(starts.size());  // of each chain
  const double large = std::exchange(kernels.largeProbability, 0);
  std::vector<Path> found;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    ChainState current(target.maxLength()), proposed(target.maxLength());
    current.path.technique = starts[k].technique;
    current.path.sample = starts[k].sample;
    if (!target.evaluate(current.path)) continue;
    Path path = current.path;
    Random chain(settings.seed, kChainStream, k);
    MutationContext context;
    context.random = &chain;
    for (long long i = 0; i < mutations && !stopped(); ++i) {
      const auto choice = kernels.choose(current.path, chain);
      if (!choice) continue;
      proposed.forget();
      const Proposal proposal = kernels.mutation(choice->kind).propose(current, proposed, context);
      if (!proposal.made() || !inPixel(proposed.path.filmX, proposed.path.filmY) ||
          !(chain.uniform() < proposal.acceptance(current.path, proposed.path,
                                                  kernels.logRatio(*choice, proposed.path))))
        continue;
      // What a lens perturbation has joined must be there when it is traced again.
      if (!target.evaluate(proposed.path)) continue;
      proposed.forget();
      std::swap(current, proposed);
      search.accepted += 1 / static_cast<double>(settings.mutations);
      if (wantsLargest && current.path.target > path.target) path = current.path;
    }
    if (!wantsLargest) path = current.path;
    found.push_back(std::move(path));
  }
  kernels.largeProbability = large;
  return found;
}

}  // namespace h2mc
