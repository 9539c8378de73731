// The lens perturbation: the pixel moves a little, the rest of the path stays where it is as soon as
// it can [Veach 1997, section 11.3.3; Jakob and Marschner 2012 for following specular chains].
#pragma once

#include <memory>

#include "mcmc/mutation.h"

namespace h2mc {

class OptionSet;

// Moves the film position by a Gaussian and traces on with the primary coordinates that the path
// has, through specular and near-specular vertices, up to the first vertex x_i from which it can be
// reconnected to x_(i+1). From there on all vertices stay. The coordinates of the scatterings at x_i
// and x_(i+1) then follow by inverting the BSDFs' sampling, with lobes drawn anew.
//
// In the measure (film position, areas of the vertices that stay) the map is the identity, so the
// ratio of transition densities is that of the densities with which the changed coordinates sample
// what they lead to.
class LensStep final : public Mutation {
 public:
  // sigma: in film widths (and heights); threshold: lobes narrower than this, in radians, are traced
  // through. Keeps a reference.
  LensStep(const SceneTarget& target, float sigma, float threshold)
      : target_(target), sigma_(sigma), threshold_(threshold) {}
  std::string_view name() const override { return "lens"; }
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;

 private:
  // The first camera vertex whose scattering can be replaced by a reconnection to the next vertex;
  // t - 1 if there is none: then the whole subpath is traced again.
  int reconnectionVertex(const Path& path) const;
  bool canReconnect(const TracedVertex& vertex) const;
  // Sets the coordinates of camera vertex i so that it scatters along `direction`.
  bool aim(Path& path, int i, const Vec3f& direction, Random& random) const;
  // Goes on from camera vertex i to the known vertex (or escape) after it, without tracing a ray.
  bool follow(Path& path, const Path& known, int i) const;
  // log of the density with which the scatterings at the reconnection sample what follows.
  static double logDensity(const Path& path, int reconnection);

  const SceneTarget& target_;
  float sigma_, threshold_;
};

// With the options lensSigma and roughnessThreshold.
std::unique_ptr<Mutation> makeLensStep(const SceneTarget& target, const OptionSet& options);

}  // namespace h2mc
