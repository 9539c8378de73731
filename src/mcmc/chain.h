// A Markov chain over paths: Metropolis-Hastings with whatever mutations it is given.
#pragma once

#include <memory>

#include "mcmc/kernel_mixture.h"
#include "mcmc/statistics.h"
#include "render/image/film.h"

namespace h2mc {

// What chains leave: `states` for n mutations is to be divided by n and multiplied by the target's
// mean, `samples` (of large steps) to be divided by the number of large steps.
struct ChainFilms {
  explicit ChainFilms(const FilmSettings& settings)
      : states{Film(settings)}, samples{Film(settings)} {}
  void clear() {
    states.clear();
    samples.clear();
  }
  SummedFilm states, samples;
};

class Chain {
 public:
  // Starts at the path that `start` holds, which must have a positive target.
  Chain(const Target& target, const Path& start, Random random);

  // Makes one mutation. Splats the states, each with its expected weight over its target.
  void step(KernelMixture& kernels, ChainFilms& films, ChainStatistics& statistics,
            MutationContext& context);

  // Splats what has gathered on the present state.
  void flush(const KernelMixture& kernels, SummedFilm& film);
  // The same for a copy of the film that is read while the chain goes on.
  void splatPending(const KernelMixture& kernels, SummedFilm& film) const;

  // Goes on from a path of another chain, with all that is known of it: traced anew, a path that a lens
  // perturbation has joined might, by rounding, miss its mark. Preconditions: flushed, a target that is
  // positive and the present one.
  void restart(const Path& from);

  bool moved() const { return moved_; }
  const Path& path() const { return current_->path; }

 private:
  const Target& target_;
  std::unique_ptr<ChainState> current_, proposed_;
  Random random_;
  double weight_ = 0;  // of the present state, not yet splatted
  long long steps_ = 0;
  bool moved_ = false;
};

}  // namespace h2mc
