// SPDX-License-Identifier: MIT
// Many proposals of one mutation from one state.
#pragma once

#include <string>
#include <vector>

#include "inspect/local_model.h"
#include "mcmc/chain/mutation.h"

namespace h2mc {

struct InspectedProposal {
  // In the state's dimension(), the short way round in every coordinate. Empty where there is none: the
  // proposal has another technique, or ended before all of its coordinates were known.
  std::vector<float> offset;
  float filmX = -1, filmY = -1;  // where it is on the film; -1: not known
  double acceptance = 0;         // probability; 0 for what carries no light
  bool accepted = false;         // the outcome of one draw
};

// Proposals from a state, with what they achieve on average. A jump counts with the probability that
// it is made.
struct ProposalKind {
  std::string name;
  std::vector<InspectedProposal> proposals;
  double acceptance = 0;                 // mean
  double jump = 0;                       // mean length, in primary space, within the technique
  double filmJump = 0;                   // mean length on the film, in pixels
  std::vector<double> jumpAlong;         // root mean square along each of the model's eigenvectors
  int dark = 0, other = 0, unknown = 0;  // no contribution; another technique; offset not known
};

// Makes `count` proposals. The state changes only in what is derived from it.
ProposalKind propose(const Scene& scene, Mutation& mutation, ChainState& state,
                     const LocalModel& model, int count, Random random);

}  // namespace h2mc
