// SPDX-License-Identifier: MIT
// What becomes of a fresh sample: which chains start from it, for how long they run, and what their states count.
#pragma once

#include <memory>

#include "mcmc/targets/target.h"
#include "render/core/random.h"

namespace h2mc {

// A tour is a chain that begins at a connection of a fresh bidirectional sample and ends. Whatever the rule, the sum of
//
//     weight() * contribution / (target + level())
//
// over a sample's connections, which count where level() > 0, and over the states of all tours that it begins has the
// image as its mean. No normalisation is estimated, and it holds for chains of any kernel that keeps the target,
// whether or not it reaches all paths.
class TourRule {
 public:
  virtual ~TourRule() = default;
  // How many tours begin at a connection of this target, > 0.
  virtual long long toursAt(double target, Random& random) const = 0;
  // Whether a tour that has made so many mutations makes another, from a state of this target.
  virtual bool goesOn(long long made, double target, Random& random) const = 0;
  virtual double level() const = 0;
  virtual double weight() const = 0;
};

// Energy redistribution [Cline et al. 2005]. The sum of a sample's targets, its energy, is handed on in equal parts e:
// from a connection of target f start floor(f / e + xi) chains of `length` mutations, each of which deposits
// e / length. A start drawn with density p and weight f / p is, in the mean, distributed as f, and so is where a chain
// that keeps f gets from there, after any number of steps.
// `meanTarget`: an estimate of it, by which there are about `chainsASample`. It only sets the size of the parts.
std::unique_ptr<TourRule> energyRedistribution(double meanTarget, double chainsASample,
                                               long long length);

// Regeneration, as jump-restore chains do it [Holl et al. 2024]. A tour begins at each connection, and ends before each
// mutation with probability C / (f + C). In continuous time, where mutations come at the rate 1 and deaths at the rate
// C / f, and births have density 1, states have density f / C: then deaths are as many as births everywhere, and moves
// that keep f change nothing. The mean holding time, 1 / (1 + C / f), is a state's weight. So no splat is brighter than
// C, dark states die at once, and there are mean(f) / C mutations a sample: `length` if `meanTarget` is right.
std::unique_ptr<TourRule> regeneration(double meanTarget, double length);

}  // namespace h2mc
