// SPDX-License-Identifier: MIT
// Large steps: proposals that do not depend on the state.
#pragma once

#include "mcmc/chain/mutation.h"

namespace h2mc {

class LargeStep : public Mutation {
 public:
  std::string_view name() const override { return "large"; }
  // An unbiased estimate of the film's mean luminance that the last proposal gives; zero if it was dark.
  double lastEstimate() const { return lastEstimate_; }
  // With which density proposals cover the primary space of a technique.
  virtual double density(const Technique& technique) const = 0;
  // Adds the last proposal to a film, a sample by itself. `division` gives the one for a density of 1: that of a
  // technique has `density` times its level.
  virtual void splatSample(const ChainState& proposed, const Division& division,
                           SampleFilm& film) const = 0;

  // For mixtures whose states are more than a path: makes known what splatState() adds. Called before every step.
  virtual void complete(ChainState&, MutationContext&) {}
  // Adds a state where a chain has stayed. `division` is that of its technique.
  virtual void splatState(const ChainState& state, double weight, const Division& division,
                          StateFilm& film) const {
    splatPath(state.path, weight, division, film);
  }

 protected:
  double lastEstimate_ = 0;
};

}  // namespace h2mc
