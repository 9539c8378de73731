// SPDX-License-Identifier: MIT
// The caustic perturbation: light leaves a rough vertex, or a lamp, in a slightly different direction, goes the same
// way through smooth surfaces and arrives at another point that the eye sees.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/path_move.h"
#include "mcmc/mutations/radial_law.h"

namespace h2mc {

// The caustic perturbation [Veach and Guibas 1997, section 5; Veach 1997, section 11.3], for paths whose x_(k-1)
// can be joined (see joinable()). Let x_l, l <= k - 2, be the next vertex towards the light that can be joined, x_0 if
// no other. The direction from x_l to x_(l+1) turns by an angle theta of Veach's law (radial_law.h), x_(l+1) .. x_(k-1)
// are traced anew with the primary coordinates of the light's side that x has, and x_(k-1) is joined to the eye.
// Where x_0 is an infinite light, its ray keeps the direction and moves sideways instead.
//
// The law's bounds are those of the lens perturbation on the film, turned into angles at x_l as if light went straight
// on from there:
//
//     radians per pixel * |x_k - x_(k-1)| / (|x_(l+1) - x_l| + .. + |x_(k-1) - x_(k-2)|)
//
// times as large, and for an infinite light into distances across its rays. They are a function of the path: theta has
// to be within those of y too. Their ratio is always the same, so the law's densities cancel. What is left of the
// densities per mu is p(x) for x_(l+1) .. x_(k-1) made from the light without the density of the direction at x_l:
//
//     q(y -> x) / q(x -> y) = p(x) / p(y).
class CausticPerturbation : public Mutation {
 public:
  // Keeps a reference.
  CausticPerturbation(const PathTarget& target, float threshold, SlotNumbers& slots);
  std::string_view name() const override { return "caustic"; }
  bool applies(const Path& path) const override {
    const int k = path.technique.length();
    return k >= 2 && joinable(target_.scene(), path, k - 1, threshold_);
  }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) final;

 protected:
  // Of the way from `path`, whose light turns at x_l.
  RadialLaw lawAt(const FullPath& path, int l) const;
  // Whether the way back from y by r is within its bounds.
  virtual bool leadsBack(const FullPath& y, int l, double r) const {
    return lawAt(y, l).reaches(r);
  }
  // log p
  virtual double logTraced(const FullPath& path, const TechniqueDensities& densities, int l) const;
  const Scene& scene() const { return target_.scene(); }

 private:
  // Traces the moved path on to x_(k-1), after a move by r.
  std::optional<Refusal> trace(const FullPath& x, int l, double r, Random& random);

  const PathTarget& target_;
  float threshold_;
  RadialLaw angles_;  // on the film, as seen from the eye
  PathMove move_;
};

MutationPlugin causticPerturbation();

}  // namespace h2mc
