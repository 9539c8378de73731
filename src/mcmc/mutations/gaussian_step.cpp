// SPDX-License-Identifier: MIT
#include "mcmc/mutations/gaussian_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcmc/mutations/primary_offset.h"

namespace h2mc {

const Gaussian& GaussianStep::gaussianAt(ChainState& state, MutationContext& context) const {
  auto& [gaussian, known] = state.derived[gaussian_];
  if (known) {
    ++context.derivatives.kept;
    return gaussian;
  }
  known = true;
  ++context.derivatives.computed;
  make(state.path, context, gaussian);
  return gaussian;
}

double GaussianStep::logDensity(const Gaussian& gaussian, const Path& from,
                                const float* offset) const {
  double sum = gaussian.logDensity(offset);
  if (target_.shared().time && !from.moving) {
    const double time = offset[from.timeCoordinate()];
    sum -= 0.5 * squared(time / sigma_) + std::log(double(sigma_));
  }
  return sum;
}

std::optional<double> GaussianStep::logDensity(ChainState& from, ChainState& to,
                                               MutationContext& context) const {
  const Path &a = from.path, &b = to.path;
  const int dimension = a.technique.dimension();
  // Choices stay, and either way has to be one that the other can take back.
  if (!(a.technique == b.technique) || a.wraps != b.wraps ||
      !std::equal(a.sample.choice.begin(), a.sample.choice.begin() + a.technique.choices(),
                  b.sample.choice.begin()))
    return -std::numeric_limits<double>::infinity();
  float offset[kMaxCoordinates];
  offsetBetween(a.sample, b.sample, dimension, a.wraps, offset);
  sharedOffsetBetween(target_.shared(), a.sample, b.sample, offset + dimension);
  return logDensity(gaussianAt(from, context), a, offset);
}

Proposal GaussianStep::propose(ChainState& current, ChainState& proposed,
                               MutationContext& context) {
  const Path& from = current.path;
  Path& to = proposed.path;
  const int dimension = from.technique.dimension();
  const SharedCoordinates shared = target_.shared();
  ++context.derivatives.steps;
  const Gaussian& gaussian = gaussianAt(current, context);
  float offset[kMaxCoordinates];
  gaussian.sample(*context.random, offset);
  // Time that the path does not depend on: the prior.
  for (int i = gaussian.dimension; i < dimension + shared.count(); ++i)
    offset[i] = sigma_ * context.random->normal();
  to.technique = from.technique;
  to.sample.choice = from.sample.choice;
  if (!addToShared(shared, from.sample, offset + dimension, to.sample)) return Proposal::none();
  if (!addOffset(from.sample, offset, dimension, from.wraps, to.sample)) return Proposal::none();
  if (!target_.evaluate(to)) {
    ++context.derivatives.dark;
    return Proposal::none();
  }
  const double back = *logDensity(proposed, current, context);
  if (!std::isfinite(back)) return Proposal::none();
  float forward[kMaxCoordinates];
  offsetBetween(from.sample, to.sample, dimension, from.wraps, forward);
  sharedOffsetBetween(shared, from.sample, to.sample, forward + dimension);
  return Proposal::withLogRatio(back - logDensity(gaussian, from, forward));
}

}  // namespace h2mc
