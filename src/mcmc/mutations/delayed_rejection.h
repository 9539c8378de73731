// SPDX-License-Identifier: MIT
// Delayed rejection: a second try where the first was refused.
#pragma once

#include "mcmc/mutations/isotropic_step.h"
#include "mcmc/mutations/mutations.h"

namespace h2mc {

// First an isotropic step from x to y, cheap or bold; where it is refused, another mutation's from x to z [Tierney and
// Mira 1999; Rioux-Lavoie et al. 2020, "Delayed Rejection Metropolis Light Transport"]. It is accepted by Green and
// Mira's rule [2001]: with y* = z - (y - x), the first try of which z would have to be refused on the way back, a(., .)
// the acceptance of first tries and q the densities of the second,
//
//     min(1, f(z) q(z -> x) (1 - a(z, y*)) / (f(x) q(x -> z) (1 - a(x, y)))).
//
// First tries are symmetric and the same everywhere, all coordinates wrapping, so that their densities cancel: in the
// older form, where y itself is on both ways, that of going from z to y is next to nothing in many dimensions. It takes
// one more path, y*. Where first tries are always accepted, there are no second ones, which cost nothing then.
class DelayedRejection : public Mutation {
 public:
  // Keeps a reference. first: standard deviation of the first try. `second` keeps the technique.
  DelayedRejection(const Target& target, std::string_view name, float first,
                   std::unique_ptr<Mutation> second)
      : target_(target),
        name_(name),
        first_(target, StepShape::kGaussian, first, 0, true),
        second_(std::move(second)) {}
  std::string_view name() const override { return name_; }
  bool applies(const Path& path) const override { return second_->applies(path); }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override {
    return first_.propose(current, proposed, context);
  }
  bool triesAgain() const override { return true; }
  Proposal proposeAgain(ChainState& current, const ChainState& refused, ChainState& proposed,
                        ChainState& back, MutationContext& context) override;
  void learn(const ChainStatistics& statistics, std::size_t kind) override {
    second_->learn(statistics, kind);
  }
  void archive(Archive& archive) override { second_->archive(archive); }

 protected:
  const Target& target() const { return target_; }
  // A coordinate of y* by those of x, y and z.
  virtual float back(float x, float y, float z) const;

 private:
  const Target& target_;
  std::string_view name_;
  IsotropicStep first_;
  std::unique_ptr<Mutation> second_;
};

// The second try: a smaller step, or one that derivatives give.
MutationPlugin isotropicThenTimid();
MutationPlugin isotropicThenHamiltonian();
MutationPlugin isotropicThenLangevin();

}  // namespace h2mc
