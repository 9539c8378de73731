// SPDX-License-Identifier: MIT
// Whole bidirectional samples as states of chains: both subpaths, and the light of each camera vertex.
#pragma once

#include "mcmc/mutations/lazy_point.h"
#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/weighed_connections.h"

namespace h2mc {

// The bidirectional sample around a state: where it is in primary space, and what it contributes.
struct WholeSample {
  LazyPoint coordinates;
  WeighedConnections connections;
};

// Coordinates that are drawn as they are read, into a point that has just begun.
class NewCoordinates final : public SampleCoordinates {
 public:
  NewCoordinates(LazyPoint& point, Random& random) : point_(point), random_(random) {}
  float read(int place) override {
    const float value = random_.uniform();
    point_.set(place, value);
    return value;
  }
  void set(int place, float value) override { point_.set(place, value); }

 private:
  LazyPoint& point_;
  Random& random_;
};

// Primary sample space Metropolis light transport [Kelemen et al. 2002] has a whole sample X as its state, and W(X),
// the sum f_i of its connections' targets, as its target. Here a state is one path: connection i, drawn with
// probability f_i / W(X). On the pairs (X, i) with density f_i the step from X to X' with i' drawn in that way is
// accepted with probability min(1, W(X') / W(X)): X moves as if nothing were ever picked, and other mutations may move
// i between.
//
// To them, the coordinates that i does not use are uniform and independent: where a sample is not known, because
// another mutation has moved the path or because the chain has forgotten it (Chain::kDerivedAnew), they are drawn anew.
class WholeSamples {
 public:
  // Keeps a reference.
  WholeSamples(const PathTarget& target, int minLength, Slot<WholeSample> slot)
      : target_(target), minLength_(minLength), slot_(slot), sampler_(target.maxLength()) {}

  // The sample around a state.
  WholeSample& around(ChainState& state, MutationContext& context);
  // What is known of it already.
  WholeSample& of(ChainState& state) const { return state.derived[slot_].value; }
  const WholeSample& of(const ChainState& state) const { return state.derived[slot_].value; }
  // Makes `proposed` a connection of the sample at `coordinates`, which keeps them in of(proposed).
  Proposal propose(ChainState& current, ChainState& proposed, SampleCoordinates& coordinates,
                   MutationContext& context);
  int places() const { return sampler_.places(); }

 private:
  const PathTarget& target_;
  int minLength_;
  Slot<WholeSample> slot_;
  BidirectionalSampler sampler_;
};

}  // namespace h2mc
