// SPDX-License-Identifier: MIT
// A Markov chain over paths: Metropolis-Hastings with whatever mutations it is given.
#pragma once

#include <memory>

#include "mcmc/chain/kernel_mixture.h"
#include "mcmc/chain/statistics.h"

namespace h2mc {

class Chain {
 public:
  // Starts at the path that `start` holds, which must have a positive target.
  Chain(const Target& target, const Path& start, Random random);

  // Makes one mutation. Splats the states, each with its expected weight over its target.
  void step(KernelMixture& kernels, ChainFilms& films, ChainStatistics& statistics,
            MutationContext& context);

  // Splats what has gathered on the present state.
  void flush(const KernelMixture& kernels, StateFilm& film);

  // Goes on from a path of another chain, with all that is known of it: traced anew, a path that a lens
  // perturbation has joined might, by rounding, miss its mark. Preconditions: flushed, a target that is
  // positive and the present one.
  void restart(const Path& from);
  // Goes on from there as a new chain would that draws from `random`.
  void begin(const Path& from, Random random);

  // Where it stands, between two steps. Precondition: flushed.
  void archive(Archive& archive);
  // After so many steps what is derived from the state is made anew. A chain that has been read from an archive begins
  // without it: if it was written after a multiple of these, its further steps are the same, to the bit.
  static constexpr long long kDerivedAnew = 128;

  bool moved() const { return moved_; }
  const Path& path() const { return current_->path; }

 private:
  void propose(const KernelMixture::Choice& choice, KernelMixture& kernels, ChainFilms& films,
               ChainStatistics& statistics, MutationContext& context);

  // After the proposal was refused that was to be accepted with probability `first`. Returns with which the second one
  // is, which it counts.
  double proposeAgain(const KernelMixture::Choice& choice, double first, KernelMixture& kernels,
                      ChainFilms& films, AcceptanceCount& count, double& departures,
                      MutationContext& context);
  // With probability `acceptance` goes on from the state, splatted with that weight; adds it to `departures` if the
  // state is more than a pixel away.
  bool accept(std::unique_ptr<ChainState>& proposed, double acceptance, KernelMixture& kernels,
              Mutation& mutation, StateFilm& film, double& departures);

  const Target& target_;
  std::unique_ptr<ChainState> current_, proposed_;
  std::unique_ptr<ChainState> second_, back_;  // of second tries; null before the first of them
  Slots memory_;                               // of the kernels
  Random random_;
  double weight_ = 0;  // of the present state, not yet splatted
  long long steps_ = 0;
  bool moved_ = false;
};

}  // namespace h2mc
