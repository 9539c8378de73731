// SPDX-License-Identifier: MIT
#include "mcmc/mutations/whole_sample.h"

#include <cmath>

namespace h2mc {

WholeSample& WholeSamples::around(ChainState& state, MutationContext& context) {
  auto& slot = state.derived[slot_];
  WholeSample& whole = slot.value;
  if (slot.known) return whole;
  slot.known = true;
  whole.coordinates.begin(places());
  whole.connections.clear();
  NewCoordinates coordinates(whole.coordinates, *context.random);
  const auto add = [&](const BidirectionalSampler::Connection& c) {
    whole.connections.add(target_, c);
  };
  context.notFinite.add(
      sampler_, sampler_.complete(target_.scene(), coordinates, state.path, minLength_, add));
  return whole;
}

Proposal WholeSamples::propose(ChainState& current, ChainState& proposed,
                               SampleCoordinates& coordinates, MutationContext& context) {
  const WeighedConnections& from = around(current, context).connections;
  auto& [whole, known] = proposed.derived[slot_];
  known = true;
  WeighedConnections& to = whole.connections;
  to.clear();
  const auto add = [&](const BidirectionalSampler::Connection& c) { to.add(target_, c); };
  context.notFinite.add(sampler_, sampler_.sample(target_.scene(), coordinates, minLength_, add));
  if (!(to.sum() > 0)) return Proposal::none(Refusal::kDark);
  const Technique technique = to.pick(*context.random).connection.technique;
  if (!sampler_.path(target_.scene(), technique, proposed.path) || !target_.weigh(proposed.path))
    return Proposal::none(Refusal::kDark);
  // The density of the way there has f_i' / W', that of the way back f_i / W.
  return Proposal::withLogRatio(std::log(to.sum() / proposed.path.target) -
                                std::log(from.sum() / current.path.target));
}

}  // namespace h2mc
