// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/weighed_connections.h"

namespace h2mc {

// A whole bidirectional sample, of which one connection is drawn in proportion to its target.
//
// The chain's space is extended by the coordinates of the sample that its path does not use: they are uniform and
// independent of everything, so they may be drawn when they are needed. On the extended space, proposing a sample X'
// with connections i of target f_i' and picking i with probability f_i' / W(X'), W = sum of f_i, is accepted with
// probability min(1, W(X') / W(X)): the connection picked cancels. W varies less than any one technique's f.
//
// propose() decides by itself, and returns only what is accepted: of the rest it leaves technique, sample, film
// position and target, but no vertices.
class BidirectionalLargeStep final : public LargeStep {
 public:
  // Keeps a reference.
  BidirectionalLargeStep(const PathTarget& target, int minLength, SlotNumbers& slots)
      : target_(target),
        minLength_(minLength),
        sampler_(target.maxLength()),
        whole_(slots.add<double>()) {}
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  // All connections: the acceptance does not depend on which was picked.
  void splatProposal(const ChainState& proposed, double weight, const Division& division,
                     StateFilm& film) const override;
  double density(const Technique&) const override { return 1; }
  void splatSample(const ChainState& proposed, const Division& division,
                   SampleFilm& film) const override;

 private:
  // W of the bidirectional sample around a state.
  double wholeAround(ChainState& state, MutationContext& context);

  const PathTarget& target_;
  int minLength_;
  BidirectionalSampler sampler_;
  Slot<double> whole_;              // W of a whole sample around the state
  WeighedConnections connections_;  // of the last proposal
};

LargeStepPlugin bidirectionalLargeStep();

}  // namespace h2mc
