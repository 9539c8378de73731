// SPDX-License-Identifier: MIT
#include "mcmc/mutations/bidirectional_large_step.h"

#include <algorithm>

#include "mcmc/mutations/whole_sample_steps.h"

namespace h2mc {

double BidirectionalLargeStep::wholeAround(ChainState& state, MutationContext& context) {
  auto& whole = state.derived[whole_];
  if (whole.known) return whole.value;
  double sum = 0;
  context.notFinite.add(
      sampler_,
      sampler_.complete(target_.scene(), *context.random, state.path, minLength_,
                        [&](const BidirectionalSampler::Connection& c) { sum += target_.of(c); }));
  // The path itself is among the connections; rounding may not make it vanish.
  whole = {std::max(sum, double(state.path.target)), true};
  return whole.value;
}

Proposal BidirectionalLargeStep::propose(ChainState& current, ChainState& proposed,
                                         MutationContext& context) {
  Random& random = *context.random;
  connections_.clear();
  context.notFinite.add(sampler_, sampler_.sample(target_.scene(), random, -1, -1, minLength_,
                                                  [&](const BidirectionalSampler::Connection& c) {
                                                    connections_.add(target_, c);
                                                  }));
  lastEstimate_ = connections_.luminance();
  const double sum = connections_.sum();
  if (!(sum > 0)) return Proposal::none();
  Path& path = proposed.path;
  const auto& [chosen, target] = connections_.pick(random);
  path.technique = chosen.technique;
  path.sample = sampler_.primarySample(path.technique);
  path.target = static_cast<float>(target);
  path.filmX = chosen.filmX;
  path.filmY = chosen.filmY;

  // Accepted where threshold < W(X') / W(X). W(X) is at least the present path's target, so that most of what is
  // rejected needs no other connections of the present sample, and only what is accepted is traced.
  const double threshold = random.uniformDouble();
  if (sum < threshold * current.path.target || sum < threshold * wholeAround(current, context) ||
      !target_.evaluate(path))
    return Proposal::none();
  proposed.derived[whole_] = {sum, true};
  return Proposal::accepted();
}

void BidirectionalLargeStep::splatProposal(const ChainState&, double weight,
                                           const Division& division, StateFilm& film) const {
  connections_.splatStates(weight, division, film);
}

void BidirectionalLargeStep::splatSample(const ChainState&, const Division& division,
                                         SampleFilm& film) const {
  connections_.splatSamples(division, film);
}

LargeStepPlugin bidirectionalLargeStep() {
  return {
      "bidirectional",
      "a whole bidirectional sample, of which one connection is taken in proportion to its target",
      {},
      [](const MutationSetup& setup) -> std::unique_ptr<LargeStep> {
        if (setup.wholeSamples) return std::make_unique<WholeLargeStep>(setup);
        return std::make_unique<BidirectionalLargeStep>(setup.target, setup.minLength, setup.slots);
      },
      nullptr,
      true};
}

}  // namespace h2mc
