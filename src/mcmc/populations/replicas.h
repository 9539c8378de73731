// SPDX-License-Identifier: MIT
// Replica exchange: chains of flatter targets beside those that make the picture.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "mcmc/chain/chain.h"
#include "mcmc/targets/tempered_target.h"

namespace h2mc {

// Lets two chains change places with probability min(1, a(y) b(x) / (a(x) b(y))), x being the state of `lower`, of
// target a, and y that of `upper`, of target b: whatever the targets, their product is kept. Returns the probability.
// Both are flushed. `places`: room for two paths.
double exchangePlaces(Chain& lower, const PathTarget& ofLower, Chain& upper,
                      const PathTarget& ofUpper, Random& random, std::array<Path, 2>& places);

// A ladder of chains, one for each rung, whose targets are the luminance to falling powers [Swendsen and Wang 1986; in
// rendering Kitaoka et al. 2009, whose replicas are the densities of techniques]. A chain that would not leave a narrow
// bright place for thousands of mutations leaves it by being handed up, where neighbours change places. Nothing of the
// rungs' own states gets into the picture.
//
// One ladder serves a group of chains: each of them in turn is its lowest rung, or the neighbour of it.
class Replicas {
 public:
  // Powers of `rungs` rungs: evenly spaced from 1 (the chains', which is none of them) down to `least`.
  static std::vector<double> powers(int rungs, double least);
  using MakeKernels = std::function<KernelMixture(const PathTarget& target)>;

  // Keeps a reference to `target`, that of the chains: it may change whenever their states are evaluated anew. All
  // rungs begin at the path `start`, of positive luminance, and run a while by themselves. `mean`: of the luminance.
  Replicas(const PathTarget& target, const std::vector<double>& powers, double mean,
           const MakeKernels& makeKernels, const Path& start, std::uint64_t seed,
           std::uint64_t number);

  // Makes so many mutations on each rung, and lets neighbours change places.
  void run(long long steps);
  // Lets the chain change places with the lowest rung. Precondition: flushed.
  void exchange(Chain& chain);

  void archive(Archive& archive);

  // Of a rung: how often its lower neighbour and it were to change places, and did.
  struct Rung {
    double power;
    long long mutations;
    AcceptanceCount exchanges;
    void add(const Rung& other) {
      power = other.power;
      mutations += other.mutations;
      exchanges.add(other.exchanges);
    }
  };
  std::vector<Rung> rungs() const;

 private:
  struct Replica {
    std::unique_ptr<TemperedTarget> target;
    KernelMixture kernels;
    ChainStatistics statistics;
    MutationContext context;
    std::unique_ptr<Chain> chain;
    AcceptanceCount exchanges;
  };
  void step(Replica& replica, long long steps);
  void exchange(Chain& lower, const PathTarget& ofLower, Replica& upper);

  const PathTarget& target_;
  std::vector<Replica> replicas_;
  ChainFilms films_;  // thrown away
  std::array<Path, 2> places_;
  Random random_;
};

}  // namespace h2mc
