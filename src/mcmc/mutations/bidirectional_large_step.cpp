// SPDX-License-Identifier: MIT
#include "mcmc/mutations/bidirectional_large_step.h"

#include <algorithm>

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
  lastEstimate_ = 0;
  sum_ = 0;
  context.notFinite.add(sampler_, sampler_.sample(target_.scene(), random, -1, -1, minLength_,
                                                  [&](const BidirectionalSampler::Connection& c) {
                                                    connections_.push_back({c, target_.of(c)});
                                                    sum_ += connections_.back().target;
                                                    lastEstimate_ += luminance(c.contribution);
                                                  }));
  if (!(sum_ > 0)) return Proposal::none();
  double u = random.uniformDouble() * sum_;
  std::size_t picked = 0;
  while (picked + 1 < connections_.size() && (u -= connections_[picked].target) >= 0) ++picked;
  Path& path = proposed.path;
  const BidirectionalSampler::Connection& chosen = connections_[picked].connection;
  path.technique = chosen.technique;
  path.sample = sampler_.primarySample(path.technique);
  path.target = static_cast<float>(connections_[picked].target);
  path.filmX = chosen.filmX;
  path.filmY = chosen.filmY;

  // Accepted where threshold < W(X') / W(X). W(X) is at least the present path's target, so that most of what is
  // rejected needs no other connections of the present sample, and only what is accepted is traced.
  const double threshold = random.uniformDouble();
  if (sum_ < threshold * current.path.target || sum_ < threshold * wholeAround(current, context) ||
      !target_.evaluate(path))
    return Proposal::none();
  proposed.derived[whole_] = {sum_, true};
  return Proposal::accepted();
}

void BidirectionalLargeStep::splatProposal(const ChainState&, double weight,
                                           const Division& division, StateFilm& film) const {
  // target / sum is the probability of having picked this one.
  for (const auto& [c, target] : connections_)
    film.splat(c.filmX, c.filmY, c.contribution, weight * target / sum_, target, division);
}

void BidirectionalLargeStep::splatSample(const ChainState&, const Division& division,
                                         SampleFilm& film) const {
  for (const auto& [c, target] : connections_)
    film.splat(c.filmX, c.filmY, c.contribution, target, division);
}

LargeStepPlugin bidirectionalLargeStep() {
  return {
      "bidirectional",
      "a whole bidirectional sample, of which one connection is taken in proportion to its target",
      {},
      [](const MutationSetup& setup) -> std::unique_ptr<LargeStep> {
        return std::make_unique<BidirectionalLargeStep>(setup.target, setup.minLength, setup.slots);
      }};
}

}  // namespace h2mc
