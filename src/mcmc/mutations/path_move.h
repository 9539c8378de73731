// SPDX-License-Identifier: MIT
// What every mutation that moves a path, and not a technique's coordinates, begins and ends with.
#pragma once

#include <memory>

#include "mcmc/mutations/path_space.h"
#include "render/path/assemble.h"
#include "render/path/grow.h"

namespace h2mc {

// A chain's state holds a path x together with the technique i that made it. A path-space mutation forgets i, moves x
// to y with the density q(x -> y) per mu, draws a technique j of y with its MIS weight w_j(y) and assembles y in it.
// The image of the chain's target under that is the path's own (docs/path-space.md), so the ratio that
// Mutation::propose returns is, whatever the target is,
//
//     q(y -> x) p_j(y) w_i(x) / (q(x -> y) p_i(x) w_j(y)).
//
// A move that is a step in the primary space of some reference technique, coordinates u to u' with the density q_*(u ->
// u'), has q(x -> y) = q_*(u -> u') p_*(y), p_* being the density with which that technique makes what has moved: a
// difference of TechniqueDensities::fromCamera or fromLight.
class PathMove {
 public:
  // Keeps a reference.
  PathMove(const PathTarget& target, SlotNumbers& slots)
      : target_(target),
        pathSpace_(slots.shared<PathSpaceState>()),
        assembles_(slots.shared<Assembles>()),
        work_(slots.workplace<Workplace>(target.maxLength())) {}

  // The path x of a state; null where rounding keeps its technique from having it, so that no way leads back.
  const PathSpaceState* from(ChainState& current, MutationContext& context);
  // A path to be moved that begins as x: with its light, time and vertices x_0 .. x_k.
  FullPath& begin(const FullPath& x);
  // The path that begin() has returned.
  FullPath& path() { return work_->to; }
  // Whether the edge between x_(i-1) and x_i of the moved path is free. One ray.
  bool free(int i) const { return edgeVisible(target_.scene(), work_->to, i); }
  // The densities of the moved path. It must not change any more.
  const TechniqueDensities& arrive();
  // Makes `proposed` the moved path, all edges of which are known to be free, in a technique drawn by its MIS weight.
  // `logMove`: log q(y -> x) - log q(x -> y), per mu. Precondition: arrive() after from() of the same state.
  Proposal finish(ChainState& current, ChainState& proposed, double logMove,
                  MutationContext& context);

 private:
  struct Assembles {
    bool inItsTechnique;
  };
  struct Workplace {
    explicit Workplace(int maxLength) : back(maxLength) {}
    FullPath to;
    TechniqueDensities there;
    Path back;  // the way back, tried
  };

  const PathTarget& target_;
  Slot<PathSpaceState> pathSpace_;
  Slot<Assembles> assembles_;
  std::shared_ptr<Workplace> work_;
};

// A technique of the path drawn by its MIS weight; -1 where none makes it.
int drawTechnique(const TechniqueDensities& densities, Random& random);

}  // namespace h2mc
