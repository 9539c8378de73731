// A Markov chain over paths: Metropolis-Hastings with whatever mutations it is given.
#pragma once

#include <memory>

#include "mcmc/large_step.h"
#include "mcmc/statistics.h"
#include "render/image/film.h"

namespace h2mc {

// The mixture of kernels that chains run: a large step with a fixed probability, otherwise one of the
// small ones. The choice depends on the technique alone, which small steps keep.
struct KernelMixture {
  std::unique_ptr<LargeStep> large;
  double largeProbability = 0.3;
  struct Small {
    std::unique_ptr<Mutation> mutation;
    double cameraShare;  // of the small steps for techniques with t >= 2
    double lightShare;   // for t = 1, where the film position is not a coordinate
  };
  std::vector<Small> small;
  // Mean of the target over all techniques' spaces, or an estimate made before the chains have run;
  // 0 where large steps are proposals and nothing else. Otherwise they also count as independent
  // samples of the image, weighted against the chains' states by the balance heuristic
  // [Kelemen et al. 2002, section 3.4]: in n mutations there are n * largeProbability * density of
  // these where there are n * target / brightness of those. With share = largeProbability *
  // brightness, a state's contribution is then divided by target + share * density, and a sample's
  // multiplied by share / (target + share * density), whatever the true brightness is.
  double brightness = 0;

  double share() const { return largeProbability * brightness; }
  double shared(const Technique& technique) const {
    return brightness > 0 ? share() * large->density(technique) : 0;
  }
  // Kinds of mutation: 0 is the large step, k the small one k - 1.
  int kinds() const { return 1 + static_cast<int>(small.size()); }
  std::vector<std::string> kindNames() const;
  Mutation& mutation(std::size_t kind) { return kind ? *small[kind - 1].mutation : *large; }
  // Draws the kind for a state of this technique. Two random numbers, one for a large step.
  std::size_t choose(const Technique& technique, Random& random) const;
};

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
