// SPDX-License-Identifier: MIT
// A bidirectional sample's connections, of which a chain takes one.
#pragma once

#include <vector>

#include "mcmc/chain/chain_films.h"
#include "mcmc/targets/target.h"

namespace h2mc {

class WeighedConnections {
 public:
  void clear() {
    list_.clear();
    sum_ = luminance_ = 0;
  }
  void add(const PathTarget& target, const BidirectionalSampler::Connection& c) {
    list_.push_back({c, target.of(c)});
    sum_ += list_.back().target;
    luminance_ += h2mc::luminance(c.contribution);
  }
  // W, the sum of their targets.
  double sum() const { return sum_; }
  // Of what they contribute together: of a sample at a uniform point an estimate of the film's mean luminance.
  double luminance() const { return luminance_; }

  struct Weighed {
    BidirectionalSampler::Connection connection;
    double target;
  };
  // One, in proportion to its target. Precondition: sum() > 0.
  const Weighed& pick(Random& random) const {
    double u = random.uniformDouble() * sum_;
    std::size_t picked = 0;
    while (picked + 1 < list_.size() && (u -= list_[picked].target) >= 0) ++picked;
    return list_[picked];
  }

  // All of them, each with the probability that it is the one picked: for steps whose acceptance does not depend on
  // that.
  void splatStates(double weight, const Division& division, StateFilm& film) const {
    for (const auto& [c, target] : list_)
      film.splat(c.filmX, c.filmY, c.contribution, weight * target / sum_, target, division);
  }
  // As a sample by itself.
  void splatSamples(const Division& division, SampleFilm& film) const {
    for (const auto& [c, target] : list_)
      film.splat(c.filmX, c.filmY, c.contribution, target, division);
  }

 private:
  std::vector<Weighed> list_;
  double sum_ = 0, luminance_ = 0;
};

}  // namespace h2mc
