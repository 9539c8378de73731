// SPDX-License-Identifier: MIT
// Steps in primary space drawn from a Gaussian that derivatives give at the state.
#pragma once

#include "mcmc/mutations/gaussian.h"
#include "mcmc/mutations/mutations.h"

namespace h2mc {

// The offset of all continuous coordinates is drawn from a Gaussian that is a function of the state; choices stay as
// they are. What Gaussian, derived classes say.
//
// Where the target has time, it always moves along. The Gaussian covers it if the path depends on it, and otherwise it
// is drawn from a prior of its own, N(0, sigma^2). Either way a proposal is drawn from a density over the same space,
// whether or not the other state's path depends on time.
class GaussianStep : public Mutation {
 public:
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  std::optional<double> logDensity(ChainState& from, ChainState& to,
                                   MutationContext& context) const override;

 protected:
  // Keeps a reference.
  GaussianStep(const Target& target, float sigma, SlotNumbers& slots)
      : target_(target), sigma_(sigma), gaussian_(slots.add<Gaussian>()) {}

  const Target& target() const { return target_; }
  float sigma() const { return sigma_; }

 private:
  // The Gaussian at the path, of path.dimension() coordinates; counts what it has computed.
  virtual void make(const Path& path, MutationContext& context, Gaussian& gaussian) const = 0;
  // The same, made once for each state.
  const Gaussian& gaussianAt(ChainState& state, MutationContext& context) const;
  // Of an offset in the technique's coordinates, and in time after them where the target has it.
  double logDensity(const Gaussian& gaussian, const Path& from, const float* offset) const;

  const Target& target_;
  float sigma_;
  Slot<Gaussian> gaussian_;
};

}  // namespace h2mc
