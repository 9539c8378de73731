// Small steps within a technique's primary space: isotropic ones, and those of the Gaussian that
// Hamiltonian dynamics gives.
#pragma once

#include "mcmc/mutation.h"

namespace h2mc {

// x + offset for the technique's continuous coordinates: those in `wraps` modulo 1. False when a
// coordinate that does not wrap leaves [0, 1), or a wrapping one has moved by half a turn or more,
// so that the offset is not the shortest way back: such proposals are rejected, in both directions.
bool addOffset(const PrimarySample& from, const float* offset, int dimension, CoordinateMask wraps,
               PrimarySample& to);

// The offset that leads from one sample to the other, the shortest way round where coordinates wrap.
void offsetBetween(const PrimarySample& from, const PrimarySample& to, int dimension,
                   CoordinateMask wraps, float* offset);

// The same for time, which does not wrap: false outside [0, 1).
bool addToTime(const PrimarySample& from, float offset, PrimarySample& to);

// How far an isotropic step goes in each coordinate.
enum class StepShape {
  kGaussian,  // normal with standard deviation sigma
  kKelemen,   // exponential between 1/1024 and 1/64 [Kelemen et al. 2002]
};

// Symmetric steps in all coordinates, discrete choices and time included. All coordinates wrap, which is
// symmetric whatever the target does at the borders, but for time: it is reflected there.
class IsotropicStep final : public Mutation {
 public:
  IsotropicStep(const Target& target, StepShape shape, float sigma)
      : target_(target), shape_(shape), sigma_(sigma) {}
  std::string_view name() const override { return "isotropic"; }
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;

 private:
  float offset(Random& random) const;

  const Target& target_;
  StepShape shape_;
  float sigma_;
};

// Steps drawn from hamiltonianGaussian() at the state; choices stay as they are. Where there are no
// derivatives the Gaussian is the prior.
//
// Where the target has time, it always moves along. The Gaussian covers it if the path depends on it,
// and otherwise it is drawn from a prior of its own, N(0, sigma^2). Either way a proposal is drawn from
// a density over the same space, whether or not the other state's path depends on time.
class HamiltonianStep final : public Mutation {
 public:
  HamiltonianStep(const Target& target, const HamiltonianSettings& settings)
      : target_(target), settings_(settings) {}
  std::string_view name() const override { return "hessian-hamiltonian"; }
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;

 private:
  void prepare(ChainState& state, MutationContext& context) const;
  // Of an offset in the technique's coordinates, and in time after them where the target has it.
  double logDensity(const ChainState& state, const float* offset) const;

  const Target& target_;
  HamiltonianSettings settings_;
};

}  // namespace h2mc
