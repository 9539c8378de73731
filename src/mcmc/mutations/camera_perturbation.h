// SPDX-License-Identifier: MIT
// Perturbations of the camera's end of a path: the pixel moves, the path is traced on from there until it can go on as
// it was.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/path_move.h"
#include "mcmc/mutations/radial_law.h"

namespace h2mc {

// The lens perturbation [Veach and Guibas 1997, section 5; Veach 1997, section 11.3], and the multi-chain
// perturbation [ibid.], which differs at rough vertices that have none beside them.
//
// The film position of x moves by a vector whose length has Veach's law (radial_law.h). Let x_r be the first vertex
// from the eye such that x_r and x_(r-1) can both be joined (see joinable()). x_(k-1) .. x_r are traced anew: where x
// scatters through smooth or narrow lobes, with the primary coordinates that make x; at a rough vertex whose next one
// is not, either by these too, or in the direction of x turned by an angle of Veach's law between 0.0001 and 0.1
// degrees. x_0 .. x_(r-1) stay. Where x has no such x_r all of it is traced, up to the light.
//
// Both laws are symmetric. With p(x) the density with which the camera makes x_r .. x_(k-1) (fromCamera[r]), and p_i(x)
// that of the direction at x_i, a path-space move of these has
//
//     q(y -> x) / q(x -> y) = p(x) / p(y) times, at every x_i that has been turned, p_i(y) / p_i(x).
class CameraPerturbation : public Mutation {
 public:
  // Lobes narrower than `threshold` radians are followed, not joined. Keeps a reference.
  CameraPerturbation(const PathTarget& target, float threshold, bool turns, SlotNumbers& slots);
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) final;

 protected:
  // r; 0 where there is none. `rough`: how many rough vertices there are before.
  template <class AnyPath>
  int reconnection(const AnyPath& path, int edges, int& rough) const {
    rough = 0;
    for (int i = edges - 1; i >= 1; --i) {
      if (!joinable(target_.scene(), path, i, threshold_)) continue;
      if (joinable(target_.scene(), path, i - 1, threshold_)) return i;
      ++rough;
    }
    return 0;
  }
  // log of the density of the direction from x_i to x_(i-1), as the camera's side draws it.
  virtual double logDirectionDensity(const FullPath& path, const TechniqueDensities& densities,
                                     int i) const;

 private:
  // Traces the moved path on to x_r.
  std::optional<Refusal> trace(const FullPath& x, int r, Random& random);

  const PathTarget& target_;
  float threshold_;
  bool turns_;
  RadialLaw pixels_;
  PathMove move_;
};

}  // namespace h2mc
