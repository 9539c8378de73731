// SPDX-License-Identifier: MIT
// The lens subpath mutation: the camera's end of a path is made anew, at any pixel.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/path_move.h"

namespace h2mc {

// The lens subpath mutation [Veach and Guibas 1997, section 5; Veach 1997, section 11.3]. Let x_r be the first vertex
// from the eye that can be joined (see joinable()); the mutation is for paths on which x_(r-1) can be joined as well.
// From a point that is uniform on the film a path is traced on through what can't be joined and through delta lobes
// that are drawn where it can, to the first vertex at which neither is the case. It takes the place of x_r, whatever
// the number of vertices before it.
//
// With p(x) the density with which the camera makes x_r .. x_(k-1) (fromCamera[r]), and P(x) the probability that it
// stops at x_r, which is that of going on through no delta lobe,
//
//     q(y -> x) / q(x -> y) = p(x) P(x) / (p(y) P(y)).
//
// Veach hands out stored, stratified lens subpaths; those of one chain here are independent of each other.
class LensSubpath : public Mutation {
 public:
  // Paths of fewer than minLength edges are not proposed. Keeps a reference.
  LensSubpath(const PathTarget& target, int minLength, float threshold, SlotNumbers& slots)
      : target_(target), minLength_(minLength), threshold_(threshold), move_(target, slots) {}
  std::string_view name() const override { return "lensSubpath"; }
  bool applies(const Path& path) const override {
    const int r = firstJoinable(path, path.technique.length());
    return r > 0 && joinable(target_.scene(), path, r - 1, threshold_);
  }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) final;

 protected:
  // log P of the path that ends its camera's part at x_r.
  virtual double logStop(const FullPath& path, int r) const;

 private:
  template <class AnyPath>
  int firstJoinable(const AnyPath& path, int edges) const {
    int i = edges - 1;
    while (i > 0 && !joinable(target_.scene(), path, i, threshold_)) --i;
    return i;
  }
  // Makes the moved path, of x up to x_(r-1) and what is traced.
  std::optional<Refusal> trace(const FullPath& x, int r, Random& random);

  const PathTarget& target_;
  int minLength_;
  float threshold_;
  PathMove move_;
  FullPath traced_;
};

MutationPlugin lensSubpath();

}  // namespace h2mc
