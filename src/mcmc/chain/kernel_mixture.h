// SPDX-License-Identifier: MIT
// Which kernel a chain runs next.
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "mcmc/chain/large_step.h"
#include "mcmc/chain/statistics.h"

namespace h2mc {

// The mixture of kernels that chains run: a large step with a fixed probability, otherwise one of the small ones that
// apply to the state. Which one depends on the state: on what applies to it, and on the octave of its target.
// Acceptance has the ratio of the probabilities with which the two states choose the kernel.
//
// How a kernel fares depends on that octave more than on anything else that is known without derivatives: where the
// target is far above its mean it is so on a narrow ridge, which isotropic steps miss, and where it is low nothing is
// gained by a Hessian. So the shares of kernels that can stand for one another are learned, from what was accepted.
struct KernelMixture {
  std::unique_ptr<LargeStep> large;
  double largeProbability = 0.3;
  struct Small {
    std::unique_ptr<Mutation> mutation;
    double
        share;  // of the small steps; where some don't apply, the others divide theirs in proportion
    // What a step costs in terms of the others that have a cost: these share what they have together as learn() finds.
    std::optional<double> cost;
  };
  std::vector<Small> small;
  // Mean of the target over all techniques' spaces, or an estimate made before the chains have run; none where large
  // steps are proposals and nothing else. Otherwise they count as independent samples of the image as well.
  std::optional<double> meanTarget;
  // Bidirectional samples beside the chains, for each mutation; only beside large steps that cover all techniques.
  double baseSamples = 0;
  // Whether there is time for hardly more than base samples.
  bool brief = false;
  // Whether the division between states and samples knows for how long chains stay where they are.
  bool dividesByHolding = false;
  // Of the division, where it is not that of large steps and base samples.
  std::optional<double> level;
  // The film's, in pixels.
  float width = 1, height = 1;

  // For samples of density 1. In n mutations there are n * largeProbability * density samples by large steps and
  // n * baseSamples others, where there are n * target / meanTarget states.
  Division division() const;
  // For a technique's states.
  Division division(const Technique& technique) const {
    Division result = division();
    if (meanTarget) result.level *= large->density(technique);
    return result;
  }
  // Kinds of mutation: 0 is the large step, k the small one k - 1.
  int kinds() const { return 1 + static_cast<int>(small.size()); }
  std::vector<std::string> kindNames() const;
  Mutation& mutation(std::size_t kind) { return kind ? *small[kind - 1].mutation : *large; }

  // Of a target > 0 over the mean; 0 where the mean is not known.
  int octave(double target) const { return meanTarget ? octaveOf(target / *meanTarget) : 0; }

  // Whether one path is more than a pixel from the other.
  bool departs(const Path& from, const Path& to) const {
    return std::abs(to.filmX - from.filmX) * width > 1 ||
           std::abs(to.filmY - from.filmY) * height > 1;
  }

  struct Choice {
    std::size_t kind;
    double probability;  // with which the state draws it
  };
  // Draws the kind for a state; none where no small step applies to it and it was not to be a large one: the chain
  // stays. Two random numbers, one for a large step.
  std::optional<Choice> choose(const Path& state, Random& random) const;
  double probability(std::size_t kind, const Path& state) const;
  // log of the probability with which `proposed` draws that kind over the choice's own.
  double logRatio(const Choice& choice, const Path& proposed) const;

  // Sets the shares of the small steps that have a cost, at each octave, in proportion to the fourth power of
  // acceptance over cost, each at least kLeast of what they have together, and for how many mutations chains stay where
  // they are, and lets every kernel learn. A function of what was counted alone. Chains may not be in the middle of a
  // step.
  void learn(const ChainStatistics& statistics);
  static constexpr double kLeast = 0.01;
  // What was learned, by the kernels too, and the mean.
  void archive(Archive& archive);

 private:
  // Of the small steps, each one's share at a state. `shares` has room for all.
  void sharesAt(const Path& state, double* shares) const;

  // [small step][octave]: shares of what the steps with a cost have together; empty before learn().
  std::vector<std::vector<double>> learned_;
  // [octave]: the mutations for which a chain stays within a pixel; empty before learn().
  std::vector<double> held_;
};

}  // namespace h2mc
