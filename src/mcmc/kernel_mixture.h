// Which kernel a chain runs next.
#pragma once

#include <memory>

#include "mcmc/large_step.h"
#include "mcmc/statistics.h"

namespace h2mc {

// The mixture of kernels that chains run: a large step with a fixed probability, otherwise one of the
// small ones. Which one depends on the state: on its technique, which small steps keep, and on the level
// of its target. Acceptance then has the ratio of the probabilities with which the two states choose the
// kernel.
//
// How a kernel fares depends on that level more than on anything else that is known without
// derivatives: where the target is far above its mean it is so on a narrow ridge, which isotropic steps
// miss, and where it is low nothing is gained by a Hessian. So the shares of kernels that can stand for
// one another are learned, from what was accepted so far.
struct KernelMixture {
  std::unique_ptr<LargeStep> large;
  double largeProbability = 0.3;
  struct Small {
    std::unique_ptr<Mutation> mutation;
    double cameraShare;  // of the small steps for techniques with t >= 2
    double lightShare;   // for t = 1, where the film position is not a coordinate
    // What a step costs in terms of the others that have a cost: these share what they have together
    // as learn() finds. 0: the shares stay as they are.
    double cost = 0;
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

  // The level of a target > 0; 0 where the brightness is not known.
  int level(double target) const;
  // Index of a level in tables such as ChainStatistics::levels.
  static std::size_t at(int level) {
    const int index = level + kHighestLevel;
    return static_cast<std::size_t>(index);
  }

  // Draws the kind for a state. Two random numbers, one for a large step.
  std::size_t choose(const Path& state, Random& random) const;
  // log of the probability with which `proposed` chooses the kind over that of `current`.
  double logRatio(std::size_t kind, const Path& current, const Path& proposed) const;

  // Sets the shares of the small steps that have a cost, at each level, in proportion to the fourth
  // power of acceptance over cost, each at least kLeast of what they have together. A function of
  // what was counted alone. Chains may not be in the middle of a step.
  void learn(const ChainStatistics& statistics);
  static constexpr double kLeast = 0.01;

 private:
  double smallShare(std::size_t k, const Technique& technique, int level) const;

  // [small step][level]: shares of what the steps with a cost have together; empty before learn().
  std::vector<std::vector<double>> learned_;
};

}  // namespace h2mc
