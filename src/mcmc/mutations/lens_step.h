// SPDX-License-Identifier: MIT
// The lens perturbation: the pixel moves a little, the rest of the path stays where it is as soon as
// it can [Veach 1997, section 11.3.3; Jakob and Marschner 2012 for following specular chains].
#pragma once

#include "mcmc/mutations/gaussian.h"
#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/step_sizes.h"

namespace h2mc {

// Moves the film position by a Gaussian, round or of the 2 x 2 Hessian, and traces on with the primary coordinates
// that the path has, through specular and near-specular vertices, up to the first vertex x_i from which it can be
// reconnected to x_(i+1). From there on all vertices stay. The coordinates of the scatterings at x_i
// and x_(i+1) then follow by inverting the BSDFs' sampling, with lobes drawn anew.
//
// In the measure (film position, areas of the vertices that stay) the map is the identity, so the
// ratio of transition densities is that of the densities with which the changed coordinates sample
// what they lead to.
class LensStep final : public Mutation {
 public:
  // Where the film position goes to. `hamiltonian.sigma`, in film widths (and heights), is the
  // deviation of the round Gaussian and the prior of the one that the 2 x 2 Hessian shapes.
  struct Settings {
    HamiltonianSettings hamiltonian;
    bool hessian = false;
    float threshold = 0.1f;       // lobes narrower than this, in radians, are traced through
    double targetAcceptance = 0;  // of the round Gaussian: as StepSizes
  };
  // Keeps a reference.
  LensStep(const PathTarget& target, const Settings& settings, SlotNumbers& slots);
  std::string_view name() const override { return "lens"; }
  // Where the film position is a coordinate.
  bool applies(const Path& path) const override { return path.technique.t >= 2; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  void learn(const ChainStatistics& statistics, std::size_t kind) override {
    if (!settings_.hessian) sizes_.learn(statistics.acceptance[kind]);
  }
  void archive(Archive& archive) override { sizes_.archive(archive); }
  // The first camera vertex whose scattering can be replaced by a reconnection to the next vertex;
  // t - 1 if there is none: then the whole subpath is traced again.
  int reconnectionVertex(const Path& path) const;

 private:
  // Over film positions, of what the state's derivatives are there.
  const Gaussian& gaussianAt(ChainState& state, int reconnection, MutationContext& context) const;
  bool canReconnect(const TracedVertex& vertex) const;
  // Goes on from camera vertex i to the known vertex (or escape) after it, without tracing a ray.
  bool followKnown(Path& path, const Path& known, int i) const;
  // log of the density with which the scatterings at the reconnection sample what follows.
  static double logDensity(const Path& path, int reconnection);

  const PathTarget& target_;
  Settings settings_;
  Gaussian round_;  // the same at every state
  Slot<Gaussian> gaussian_;
  StepSizes sizes_;
};

// By the options lensSigma, lensStep and roughnessThreshold.
MutationPlugin lensStep();

}  // namespace h2mc
