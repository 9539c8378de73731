// SPDX-License-Identifier: MIT
// The path stays, its technique is drawn anew: a reversible jump between techniques' primary spaces.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/path_space.h"

namespace h2mc {

// Reversible jump MLT's change of technique [Bitterli et al. 2017]: the same path in the primary space of another
// technique, lobes and choices drawn with their probabilities given the path.
//
// Given the path x, the target's share of technique i is its MIS weight w_i(x). From i, another technique j is drawn in
// proportion to w_j and accepted with probability min(1, (1 - w_i) / (1 - w_j)), Liu's modified Gibbs step [Liu 1996],
// which moves more often than to draw j in proportion to w_j whatever i is: nothing is lost on drawing i again.
//
// With p_i the density with which technique i makes the path, the ratio of that in the primary measure is
//
//     q(j -> i) / q(i -> j) = w_i(x) p_j(x) / (w_j(x) p_i(x)) * (1 - w_i(x)) / (1 - w_j(x)).
//
// The last factor is decided here, before anything is inverted: alpha = min(1, a) min(1, b) has detailed balance where
// min(1, a b) has it. With the luminance as the target, the others cancel against the ratio of targets.
class TechniqueChange final : public Mutation {
 public:
  // Keeps a reference.
  TechniqueChange(const PathTarget& target, SlotNumbers& slots)
      : target_(target), pathSpace_(slots.shared<PathSpaceState>()), back_(target.maxLength()) {}
  std::string_view name() const override { return "technique"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;

 private:
  const PathTarget& target_;
  Slot<PathSpaceState> pathSpace_;
  Path back_;  // the way back, tried
};

MutationPlugin techniqueChange();

}  // namespace h2mc
