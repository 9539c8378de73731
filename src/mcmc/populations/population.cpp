// SPDX-License-Identifier: MIT
#include "mcmc/populations/population.h"

#include "mcmc/populations/resampling.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStartStream = 0x73746172;

class ResampledChains final : public Population {
 public:
  Members start(const Bootstrap& bootstrap, std::size_t count, int maxLength, std::uint64_t seed,
                int threads) const override {
    Random random(seed, kStartStream, count);
    const double share = bootstrap.firstHalf();
    const std::size_t half = systematicShare(share, count, random.uniformDouble());
    const double offsets[2] = {random.uniformDouble(), random.uniformDouble()};
    // Where chain c falls on the samples, as they lie side by side.
    const auto place = [&](std::size_t c) {
      if (c < half)
        return share * (static_cast<double>(c) + offsets[0]) / static_cast<double>(half);
      return share + (1 - share) * (static_cast<double>(c - half) + offsets[1]) /
                         static_cast<double>(count - half);
    };
    Members members{std::vector<Path>(count, Path(maxLength)), half};
    parallelFor(threads, static_cast<int>(count), [&](int c) {
      Random own(seed, kStartStream, static_cast<std::uint64_t>(c));
      bootstrap.drawStart(place(at(c)), own, members.states[at(c)]);
    });
    return members;
  }

  Members renew(std::span<const Path* const> states, std::size_t half,
                std::span<const double> weights, Random& random) const override {
    const ResampledHalves drawn = resampleHalves(weights, half, states.size(), random);
    Members members;
    members.half = drawn.half;
    members.states.reserve(states.size());
    for (const std::size_t k : drawn.indices) members.states.push_back(*states[k]);
    return members;
  }
};

}  // namespace

std::unique_ptr<Population> resampledChains() { return std::make_unique<ResampledChains>(); }

}  // namespace h2mc
