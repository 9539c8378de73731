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

  int kinds() const { return 1 + static_cast<int>(small.size()); }
  std::vector<std::string> kindNames() const;
};

class Chain {
 public:
  // Starts at the path that `start` holds, which must have a positive target.
  Chain(const Target& target, const Path& start, Random random);

  // Makes one mutation. Splats the states, each with its expected weight over its target, so that the
  // film's mean luminance tends to 1 per mutation.
  void step(KernelMixture& kernels, Film& film, ChainStatistics& statistics,
            MutationContext& context);

  // Splats what has gathered on the present state. Call before the film is read.
  void flush(Film& film);
  // The same for a copy of the film that is read while the chain goes on.
  void splatPending(Film& film) const;

  bool moved() const { return moved_; }
  const Path& path() const { return current_->path; }

 private:
  std::unique_ptr<ChainState> current_, proposed_;
  Random random_;
  double weight_ = 0;  // of the present state, not yet splatted
  long long steps_ = 0;
  bool moved_ = false;
};

}  // namespace h2mc
