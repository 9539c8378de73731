// The lens perturbation: the pixel moves a little, the rest of the path stays where it is as soon as
// it can [Veach 1997, section 11.3.3; Jakob and Marschner 2012 for following specular chains].
#pragma once

#include <memory>

#include "mcmc/mutation.h"

namespace h2mc {

class OptionSet;

// Moves the film position by a Gaussian, round or of the 2 x 2 Hessian, and traces on with the primary coordinates that the path
// has, through specular and near-specular vertices, up to the first vertex x_i from which it can be
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
    float threshold = 0.1f;  // lobes narrower than this, in radians, are traced through
  };
  // Keeps a reference.
  LensStep(const SceneTarget& target, const Settings& settings)
      : target_(target), settings_(settings) {}
  std::string_view name() const override { return "lens"; }
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;
  // The first camera vertex whose scattering can be replaced by a reconnection to the next vertex;
  // t - 1 if there is none: then the whole subpath is traced again.
  int reconnectionVertex(const Path& path) const;

 private:
  // The Gaussian at a state: over film positions, of what its derivatives are there.
  void prepare(ChainState& state, int reconnection, MutationContext& context) const;
  bool canReconnect(const TracedVertex& vertex) const;
  // Sets the coordinates of camera vertex i so that it scatters along `direction`.
  bool aim(Path& path, int i, const Vec3f& direction, Random& random) const;
  // Goes on from camera vertex i to the known vertex (or escape) after it, without tracing a ray.
  bool follow(Path& path, const Path& known, int i) const;
  // log of the density with which the scatterings at the reconnection sample what follows.
  static double logDensity(const Path& path, int reconnection);

  const SceneTarget& target_;
  Settings settings_;
};

// With the options lensSigma, lensStep and roughnessThreshold.
std::unique_ptr<Mutation> makeLensStep(const SceneTarget& target, const OptionSet& options);

}  // namespace h2mc
