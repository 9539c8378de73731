// SPDX-License-Identifier: MIT
#include "mcmc/populations/bootstrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/ranks.h"
#include "render/path/bidirectional.h"
#include "render/path/path_text.h"

namespace h2mc {
namespace {
constexpr std::uint64_t kStream = 0x626f6f74;  // apart from the chains' streams
constexpr long long kBlock = 4096;
constexpr int kBlocksAMeeting = 4;  // of each of a rank's threads
}  // namespace

// What a block of samples has added up.
struct Bootstrap::Block {
  std::vector<double> sum, squares;
  long long notFinite = 0, samples = 0;
  std::string firstNotFinite;
};

Bootstrap::Bootstrap(const Scene& scene, int minLength, int maxLength, long long samples,
                     std::uint64_t seed, int threads, const std::atomic<bool>* stop, Ranks* ranks)
    : scene_(scene),
      minLength_(minLength),
      maxLength_(maxLength),
      seed_(seed),
      threads_(threads),
      stop_(stop),
      ranks_(ranks) {
  const auto count = at(TechniqueDistribution(minLength, maxLength).size());
  for (auto* sum : {&techniqueSum_, &techniqueSquareSum_}) sum->assign(count, 0);
  extendTo(samples);
}

void Bootstrap::trace(Block& block, long long first, std::span<double> luminances) const {
  const TechniqueDistribution techniques(minLength_, maxLength_);
  block.sum.assign(techniqueSum_.size(), 0);
  block.squares.assign(techniqueSum_.size(), 0);
  block.samples = static_cast<long long>(luminances.size());
  BidirectionalSampler sampler(maxLength_);
  for (double& luminance : luminances) {
    Random random(seed_, kStream, static_cast<std::uint64_t>(first++));
    double sum = 0;
    const int notFinite = sampler.sample(scene_, random, -1, -1, minLength_,
                                         [&](const BidirectionalSampler::Connection& c) {
                                           const double y = h2mc::luminance(c.contribution);
                                           const auto k = at(techniques.index(c.technique));
                                           block.sum[k] += y;
                                           block.squares[k] += y * y;
                                           sum += y;
                                         });
    if (notFinite > 0 && block.notFinite == 0)
      block.firstNotFinite =
          pathText(sampler.lastNotFinite(), sampler.primarySample(sampler.lastNotFinite()));
    block.notFinite += notFinite;
    luminance = sum;
  }
}

void Bootstrap::extendTo(long long samples) {
  const auto had = static_cast<long long>(cumulative_.size());
  if (samples <= had) return;
  const std::size_t count = techniqueSum_.size();
  const auto blocks = static_cast<int>((samples - had + kBlock - 1) / kBlock);
  std::vector<Block> block(at(blocks));
  cumulative_.resize(at(samples));
  const auto luminances = [&](int b) {
    const long long first = had + b * kBlock;
    return std::span(cumulative_).subspan(at(first), at(std::min(kBlock, samples - first)));
  };
  // Ranks look at the stop flag when they meet.
  const int stretch =
      ranks_ ? kBlocksAMeeting * ranks_->agreed(std::max(threads_, 1)) * ranks_->count() : blocks;
  for (int begin = 0; begin < blocks; begin += stretch) {
    const int size = std::min(stretch, blocks - begin);
    const Share own = shareOf(ranks_, size);
    parallelFor(threads_, own.end - own.begin, [&](int i) {
      const int b = begin + own.begin + i;
      if ((had > 0 || b > 0) && stop_ && *stop_) return;
      trace(block[at(b)], had + b * kBlock, luminances(b));
    });
    exchange(ranks_, size, [&](Archive& archive, int i) {
      Block& each = block[at(begin + i)];
      archive(each.sum, each.squares, each.notFinite, each.samples, each.firstNotFinite);
      const std::span<double> all = luminances(begin + i);
      archive.bytes(all.data(), all.size_bytes());
    });
  }
  double total = had > 0 ? cumulative_[at(had) - 1] : 0;
  auto at = cumulative_.begin() + had;
  for (const Block& own : block) {
    if (own.samples == 0) {  // stopped: nobody starts there
      for (long long i = 0; i < kBlock && at != cumulative_.end(); ++i) *at++ = total;
      continue;
    }
    for (std::size_t k = 0; k < count; ++k) {
      techniqueSum_[k] += own.sum[k];
      techniqueSquareSum_[k] += own.squares[k];
    }
    notFinite_ += own.notFinite;
    if (firstNotFinite_.empty()) firstNotFinite_ = own.firstNotFinite;
    for (long long i = 0; i < own.samples; ++i, ++at) {
      luminance_.add(*at);
      *at = total += *at;
    }
  }
}

std::vector<double> Bootstrap::perSample(std::vector<double> sums) const {
  for (double& sum : sums) sum /= static_cast<double>(luminance_.count);
  return sums;
}

double Bootstrap::firstHalf() const {
  const std::size_t half = cumulative_.size() / 2;
  return half > 0 ? cumulative_[half - 1] / cumulative_.back() : 0;
}

void Bootstrap::drawStart(double u, Random& random, Path& start) const {
  const auto found =
      std::upper_bound(cumulative_.begin(), cumulative_.end(), u * cumulative_.back());
  const auto index = std::min(found, cumulative_.end() - 1) - cumulative_.begin();

  // The sample again, and one of its techniques in proportion to what it adds.
  BidirectionalSampler sampler(maxLength_);
  Random replay(seed_, kStream, static_cast<std::uint64_t>(index));
  std::vector<std::pair<Technique, double>> parts;
  double sum = 0;
  sampler.sample(scene_, replay, -1, -1, minLength_,
                 [&](const BidirectionalSampler::Connection& c) {
                   parts.emplace_back(c.technique, h2mc::luminance(c.contribution));
                   sum += parts.back().second;
                 });
  double v = random.uniformDouble() * sum;
  std::size_t k = 0;
  while (k + 1 < parts.size() && (v -= parts[k].second) >= 0) ++k;
  start.technique = parts[k].first;
  start.sample = sampler.primarySample(start.technique);
  tracePath(scene_, start);
  if (!(std::abs(start.target - parts[k].second) <= 1e-3 * parts[k].second))
    throw ReplayError(fmt::format(
        "bootstrap sample {} (seed {}), technique s={} t={}: replayed luminance {} is not {}",
        index, seed_, start.technique.s, start.technique.t, start.target, parts[k].second));
}

}  // namespace h2mc
