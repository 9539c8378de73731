// SPDX-License-Identifier: MIT
#include "mcmc/populations/replicas.h"

#include <algorithm>

#include "render/core/archive.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kRungStream = 0x72756e67, kExchangeStream = 0x65786368;

}  // namespace

double exchangePlaces(Chain& lower, const PathTarget& ofLower, Chain& upper,
                      const PathTarget& ofUpper, Random& random, std::array<Path, 2>& places) {
  const Path& x = lower.path();
  const Path& y = upper.path();
  const auto of = [](const PathTarget& target, const Path& path) {
    return target.value(path.technique, path.contribution, path.filmX, path.filmY);
  };
  const double a = of(ofLower, y), b = of(ofUpper, x);
  const double ratio = a * b / (double(x.target) * y.target);
  const double acceptance = ratio > 0 ? std::min(ratio, 1.) : 0;
  if (!(random.uniformDouble() < acceptance)) return acceptance;
  places[0] = x;
  places[1] = y;
  places[0].target = static_cast<float>(b);
  places[1].target = static_cast<float>(a);
  upper.restart(places[0]);
  lower.restart(places[1]);
  return acceptance;
}

std::vector<double> Replicas::powers(int rungs, double least) {
  std::vector<double> powers;
  for (int r = 1; r <= rungs; ++r) powers.push_back(1 - (1 - least) * r / rungs);
  return powers;
}

Replicas::Replicas(const PathTarget& target, const std::vector<double>& powers, double mean,
                   const MakeKernels& makeKernels, const Path& start, std::uint64_t seed,
                   std::uint64_t number)
    : target_(target),
      places_{Path(target.maxLength()), Path(target.maxLength())},
      random_(seed, kExchangeStream, number) {
  replicas_.reserve(powers.size());
  for (std::size_t r = 0; r < powers.size(); ++r) {
    auto own =
        std::make_unique<TemperedTarget>(target.scene(), target.maxLength(), powers[r], mean);
    KernelMixture kernels = makeKernels(*own);
    ChainStatistics statistics(kernels.kinds(), target.maxLength());
    Replica& replica = replicas_.emplace_back(
        Replica{std::move(own), std::move(kernels), std::move(statistics), {}, nullptr, {}});
    replica.chain =
        std::make_unique<Chain>(*replica.target, start, Random(seed, kRungStream + r, number));
    // Starts are those of chains, and as bright.
    step(replica, Chain::kDerivedAnew);
  }
}

void Replicas::step(Replica& replica, long long steps) {
  for (long long i = 0; i < steps; ++i)
    replica.chain->step(replica.kernels, films_, replica.statistics, replica.context);
  replica.chain->flush(replica.kernels, films_.states);
  films_.clear();
}

void Replicas::run(long long steps) {
  for (Replica& replica : replicas_) step(replica, steps);
  for (std::size_t r = replicas_.size(); r-- > 1;)
    exchange(*replicas_[r - 1].chain, *replicas_[r - 1].target, replicas_[r]);
}

void Replicas::exchange(Chain& chain) { exchange(chain, target_, replicas_[0]); }

void Replicas::exchange(Chain& lower, const PathTarget& ofLower, Replica& upper) {
  upper.exchanges.add(
      exchangePlaces(lower, ofLower, *upper.chain, *upper.target, random_, places_));
}

void Replicas::archive(Archive& archive) {
  archive(random_);
  for (Replica& replica : replicas_)
    archive(*replica.chain, replica.kernels, replica.statistics, replica.exchanges);
}

std::vector<Replicas::Rung> Replicas::rungs() const {
  std::vector<Rung> rungs;
  for (const Replica& replica : replicas_)
    rungs.push_back({replica.target->power(), replica.statistics.mutations, replica.exchanges});
  return rungs;
}

}  // namespace h2mc
