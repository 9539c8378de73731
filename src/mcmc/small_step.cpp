#include "mcmc/small_step.h"

#include <cmath>

#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// x modulo 1, in [0, 1) even where rounding would give 1.
float wrap(float x) {
  const float y = x - std::floor(x);
  return y < 1 ? y : 0;
}

bool wrapsAt(CoordinateMask wraps, int i) { return (wraps >> i) & 1; }

}  // namespace

bool addOffset(const PrimarySample& from, const float* offset, int dimension, CoordinateMask wraps,
               PrimarySample& to) {
  for (int i = 0; i < dimension; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float moved = from.u[k] + offset[i];
    if (wrapsAt(wraps, i)) {
      if (!(std::abs(offset[i]) < 0.5f)) return false;
      to.u[k] = wrap(moved);
    } else {
      if (!(moved >= 0 && moved < 1)) return false;
      to.u[k] = moved;
    }
  }
  return true;
}

void offsetBetween(const PrimarySample& from, const PrimarySample& to, int dimension,
                   CoordinateMask wraps, float* offset) {
  for (int i = 0; i < dimension; ++i) {
    const auto k = static_cast<std::size_t>(i);
    offset[i] = to.u[k] - from.u[k];
    if (wrapsAt(wraps, i)) offset[i] -= std::round(offset[i]);
  }
}

float IsotropicStep::perturb(float value, Random& random) const {
  if (shape_ == StepShape::kGaussian) return wrap(value + sigma_ * random.normal());
  constexpr float kSmallest = 1.f / 1024, kLargest = 1.f / 64;
  const float step = kLargest * std::exp(-std::log(kLargest / kSmallest) * random.uniform());
  return wrap(random.next() & 1 ? value + step : value - step);
}

bool IsotropicStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                            double& logRatio) {
  const Path& from = current.path;
  Path& to = proposed.path;
  to.technique = from.technique;
  for (int i = 0; i < from.technique.dimension(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    to.sample.u[k] = perturb(from.sample.u[k], *context.random);
  }
  for (int i = 0; i < from.technique.choices(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    to.sample.choice[k] = perturb(from.sample.choice[k], *context.random);
  }
  logRatio = 0;
  return target_.evaluate(to);
}

void HamiltonianStep::prepare(ChainState& state, MutationContext& context) const {
  if (state.hasGaussian) return;
  state.hasGaussian = true;
  const int dimension = state.path.technique.dimension();
  if (dimension > kMaxDerivativeDimension) {
    ++context.derivatives.dimension;
    return;
  }
  const double start = context.timed ? wallClock() : 0;
  Derivative derivative;
  ++context.derivatives.computed;
  const bool differentiated = target_.differentiate(state.path, derivative);
  const double middle = context.timed ? wallClock() : 0;
  if (!differentiated || !hamiltonianGaussian(derivative, settings_, state.gaussian)) {
    ++context.derivatives.notFinite;
    isotropicGaussian(dimension, settings_.sigma, state.gaussian);
  }
  if (context.timed) {
    context.seconds.derivatives += middle - start;
    context.seconds.gaussian += wallClock() - middle;
  }
}

bool HamiltonianStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                              double& logRatio) {
  const Path& from = current.path;
  Path& to = proposed.path;
  const int dimension = from.technique.dimension();
  prepare(current, context);
  float offset[2 * kMaxPathLength];
  if (dimension > kMaxDerivativeDimension) {
    // Longer than the derivative goes: the prior, which is symmetric.
    for (int i = 0; i < dimension; ++i) offset[i] = settings_.sigma * context.random->normal();
  } else {
    current.gaussian.sample(*context.random, offset);
  }
  to.technique = from.technique;
  to.sample.choice = from.sample.choice;
  if (!addOffset(from.sample, offset, dimension, from.wraps, to.sample) || !target_.evaluate(to))
    return false;
  // The way back must be one that the reverse proposal can take.
  if (to.wraps != from.wraps) return false;
  logRatio = 0;
  if (dimension > kMaxDerivativeDimension) return true;
  prepare(proposed, context);
  float forward[kMaxDerivativeDimension], back[kMaxDerivativeDimension];
  offsetBetween(from.sample, to.sample, dimension, from.wraps, forward);
  for (int i = 0; i < dimension; ++i) back[i] = -forward[i];
  logRatio = proposed.gaussian.logDensity(back) - current.gaussian.logDensity(forward);
  return true;
}

}  // namespace h2mc
