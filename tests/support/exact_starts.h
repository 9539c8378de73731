// SPDX-License-Identifier: MIT
// Independent starts for chains, distributed exactly as their target, and what an independent estimator says of the
// same samples.
#pragma once

#include <algorithm>
#include <vector>

#include "mcmc/targets/target.h"

namespace h2mc::test {

// Draws whole bidirectional samples; W, the sum of their connections' targets, decides which becomes a start: with
// probability min(1, W / bound) one of its connections does, drawn in proportion to its target, with the weight max(1,
// W / bound). So for any function h of a state, bound * weight * h(start), 0 where there is no start, has the mean of h
// over the target, not normalised: the integral of target * h over all techniques' primary spaces.
class ExactStarts {
 public:
  ExactStarts(const PathTarget& target, int minLength, std::uint64_t seed)
      : target_(target), minLength_(minLength), seed_(seed), sampler_(target.maxLength()) {
    constexpr int kPilot = 4000;
    double sum = 0;
    for (int i = 0; i < kPilot; ++i) sum += draw(1, i);
    mean_ = sum / kPilot;
  }

  // Few weights are above 1, and few samples start nothing.
  double bound() const { return 4 * mean_; }
  // About; from a few samples.
  double meanTarget() const { return mean_; }

  // Sample i. Returns the start's weight; 0: no start.
  double start(int i, Path& path) {
    const double sum = draw(0, i);
    const double chance = sum / bound();
    if (!(random_.uniformDouble() < chance)) return 0;
    double u = random_.uniformDouble() * sum;
    std::size_t picked = 0;
    while (picked + 1 < connections_.size() && (u -= target_.of(connections_[picked])) >= 0)
      ++picked;
    path.technique = connections_[picked].technique;
    path.sample = sampler_.primarySample(path.technique);
    // Rounding may put a path out that is hardly in.
    return target_.evaluate(path) ? std::max(1.0, chance) : 0;
  }
  // Of the last sample.
  const std::vector<BidirectionalSampler::Connection>& connections() const { return connections_; }

 private:
  double draw(std::uint64_t stream, int i) {
    random_ = Random(seed_, stream, static_cast<std::uint64_t>(i));
    connections_.clear();
    double sum = 0;
    sampler_.sample(target_.scene(), random_, -1, -1, minLength_,
                    [&](const BidirectionalSampler::Connection& c) {
                      connections_.push_back(c);
                      sum += target_.of(c);
                    });
    return sum;
  }

  const PathTarget& target_;
  int minLength_;
  std::uint64_t seed_;
  BidirectionalSampler sampler_;
  Random random_{0, 0, 0};
  std::vector<BidirectionalSampler::Connection> connections_;
  double mean_ = 0;
};

}  // namespace h2mc::test
