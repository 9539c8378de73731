#include "mcmc/small_step.h"

#include <algorithm>
#include <cmath>

#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// x modulo 1, in [0, 1) even where rounding would give 1.
float wrap(float x) {
  const float y = x - std::floor(x);
  return y < 1 ? y : 0;
}

// x reflected at 0 and at 1, as often as it takes.
float reflect(float x) {
  const float y = std::abs(x) - 2 * std::floor(std::abs(x) / 2);
  return std::min(y < 1 ? y : 2 - y, std::nextafter(1.f, 0.f));
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

bool addToTime(const PrimarySample& from, float offset, PrimarySample& to) {
  to.time = from.time + offset;
  return to.time >= 0 && to.time < 1;
}

float IsotropicStep::offset(Random& random) const {
  if (shape_ == StepShape::kGaussian) return sigma_ * random.normal();
  constexpr float kSmallest = 1.f / 1024, kLargest = 1.f / 64;
  const float step = kLargest * std::exp(-std::log(kLargest / kSmallest) * random.uniform());
  return random.next() & 1 ? step : -step;
}

bool IsotropicStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                            double& logRatio) {
  const Path& from = current.path;
  Path& to = proposed.path;
  to.technique = from.technique;
  for (int i = 0; i < from.technique.dimension(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    to.sample.u[k] = wrap(from.sample.u[k] + offset(*context.random));
  }
  for (int i = 0; i < from.technique.choices(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    to.sample.choice[k] = wrap(from.sample.choice[k] + offset(*context.random));
  }
  to.sample.time = from.sample.time;
  if (target_.hasTime()) to.sample.time = reflect(from.sample.time + offset(*context.random));
  logRatio = 0;
  return target_.evaluate(to);
}

void HamiltonianStep::prepare(ChainState& state, MutationContext& context) const {
  if (state.hasGaussian) {
    ++context.derivatives.kept;
    return;
  }
  state.hasGaussian = true;
  const double start = context.timed ? wallClock() : 0;
  Derivative derivative;
  ++context.derivatives.computed;
  target_.differentiate(state.path, derivative);
  context.derivatives.inDouble += derivative.inDouble;
  const double middle = context.timed ? wallClock() : 0;
  if (!hamiltonianGaussian(derivative, settings_, state.gaussian))
    ++context.derivatives.notFinite;
  else
    context.derivatives.flat += state.gaussian.isotropic;
  if (context.timed) {
    context.seconds.derivatives += middle - start;
    context.seconds.gaussian += wallClock() - middle;
  }
}

double HamiltonianStep::logDensity(const ChainState& state, const float* offset) const {
  double sum = state.gaussian.logDensity(offset);
  if (target_.hasTime() && !state.path.moving) {
    const double sigma = settings_.sigma, time = offset[state.path.technique.dimension()];
    sum -= 0.5 * squared(time / sigma) + std::log(sigma);
  }
  return sum;
}

bool HamiltonianStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                              double& logRatio) {
  const Path& from = current.path;
  Path& to = proposed.path;
  const int dimension = from.technique.dimension();
  const bool hasTime = target_.hasTime();
  ++context.derivatives.steps;
  prepare(current, context);
  float offset[kMaxCoordinates];
  current.gaussian.sample(*context.random, offset);
  // Time that the path does not depend on: the prior.
  for (int i = current.gaussian.dimension; i < dimension + hasTime; ++i)
    offset[i] = settings_.sigma * context.random->normal();
  to.technique = from.technique;
  to.sample.choice = from.sample.choice;
  to.sample.time = from.sample.time;
  if (hasTime && !addToTime(from.sample, offset[dimension], to.sample)) return false;
  if (!addOffset(from.sample, offset, dimension, from.wraps, to.sample)) return false;
  if (!target_.evaluate(to)) {
    ++context.derivatives.dark;
    return false;
  }
  // The way back must be one that the reverse proposal can take.
  if (to.wraps != from.wraps) return false;
  prepare(proposed, context);
  float forward[kMaxCoordinates], back[kMaxCoordinates];
  offsetBetween(from.sample, to.sample, dimension, from.wraps, forward);
  forward[dimension] = to.sample.time - from.sample.time;
  for (int i = 0; i <= dimension; ++i) back[i] = -forward[i];
  logRatio = logDensity(proposed, back) - logDensity(current, forward);
  return true;
}

}  // namespace h2mc
