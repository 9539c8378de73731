// SPDX-License-Identifier: MIT
// Tours that one thread runs.
#pragma once

#include <array>
#include <optional>

#include "mcmc/chain/chain.h"
#include "mcmc/tours/film_blocks.h"
#include "mcmc/tours/tour_rule.h"

namespace h2mc {

// How tours fare.
struct TourCounts {
  long long samples = 0, bright = 0;  // those with a connection that contributes
  long long tours = 0, moved = 0;     // those that made a mutation
  long long mutations = 0, longest = 0;
  void add(const TourCounts& other);
  nlohmann::json json() const;
};

// Samples come in batches of kBatch, spread evenly over the film. Batches are independent of each other, and what they
// have made of the picture tells its error without bias.
class TourGroup {
 public:
  static constexpr int kBatch = 8;

  // Keeps references. `kernels` has no large steps.
  TourGroup(const PathTarget& target, const TourRule& rule, KernelMixture kernels, int minLength,
            std::uint64_t seed, bool counting);

  // Batch number `batch` of the render, into films(): a function of its number alone, between two calls of learn().
  void run(long long batch);
  // Sets the shares of its mutations by what all groups have seen.
  void learn(const ChainStatistics& all) { kernels_.learn(all); }
  void archive(Archive& archive);

  ChainFilms& films() { return films_; }
  const KernelMixture& kernels() const { return kernels_; }
  const TourCounts& counts() const { return counts_; }
  TourCounts& counts() { return counts_; }
  const BlockMoments& blocks() const { return blocks_; }
  ChainStatistics statistics() const;

 private:
  void sample(int index, float filmX, float filmY);
  // From the connection of its last sample.
  void tours(const BidirectionalSampler::Connection& connection, double target);

  const PathTarget& target_;
  const TourRule& rule_;
  KernelMixture kernels_;
  int minLength_;
  std::uint64_t seed_;
  BidirectionalSampler sampler_;
  std::vector<BidirectionalSampler::Connection> connections_;  // of the last sample
  Path start_;
  std::optional<Chain> chain_;  // before the first tour: none
  std::uint64_t batch_ = 0, toursBegun_ = 0;
  Random random_;  // of the batch
  ChainFilms films_;
  ChainStatistics statistics_;
  MutationContext context_;
  TourCounts counts_;
  BlockMoments blocks_;
};

}  // namespace h2mc
