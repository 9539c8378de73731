// SPDX-License-Identifier: MIT
// The bidirectional mutation: a part of the path is deleted and another one, perhaps of another length, sampled in its
// place.
#pragma once

#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/path_move.h"

namespace h2mc {

// A part of a path: what lies between x_l and x_m, both of which stay. l = -1: all from the light on.
struct Window {
  int l, m;
  int edges() const { return m - l; }
};

// The bidirectional mutation [Veach and Guibas 1997, section 5; Veach 1997, section 11.3].
//
// Drawn are the new path's length k', with probabilities that are halved with each edge more or less than k; the
// number d of edges that are deleted, likewise around 2, so that a = k' - k + d are added; the window (l, l + d),
// uniformly among those that do not end at a vertex with a delta lobe; and the technique j, uniformly, that makes the
// a - 1 new vertices: those up to x_(j-1) from x_l, by sampling the scattering there or, where l = -1, a light, the
// others from x_m or the eye, then a ray to join them. x_0 is not moved for its direction alone: where l = 0 all grow
// from x_m.
//
// With P(window, a | x) the product of the probabilities before j, and S(x) the sum over all techniques j of the window
// of the density with which each makes what lies in it,
//
//     q(y -> x) / q(x -> y) = P(y -> x) S(x) / #j(x) / (P(x -> y) S(y) / #j(y)).
//
// How many windows there are to draw from is counted on either side.
class VeachBidirectional : public Mutation {
 public:
  // Keeps a reference.
  VeachBidirectional(const PathTarget& target, int minLength, SlotNumbers& slots)
      : target_(target), minLength_(minLength), move_(target, slots) {}
  std::string_view name() const override { return "veachBidirectional"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) final;

 protected:
  // How many windows of so many edges there are in a path that `added` edges can replace.
  virtual int windows(const FullPath& path, int deleted, int added) const;
  // log S
  virtual double logWindow(const FullPath& path, const TechniqueDensities& densities,
                           const Window& window) const;

 private:
  // The probabilities of a two-tailed geometric law: in proportion to 2^-|n - mode|, least <= n <= most.
  struct Geometric {
    int mode, least, most;
    double sum() const;
    double probability(int n) const;
    int draw(Random& random) const;
  };
  Geometric lengths(int edges) const { return {edges, minLength_, target_.maxLength()}; }
  // Of the number of edges to delete from a path of so many, where the length is to change by `change`.
  static Geometric deletions(int edges, int change);
  // Whether (l, l + deleted) is one of these.
  static bool isWindow(const FullPath& path, int l, int deleted, int added);
  // The first of the window's techniques; the last is m.
  static int firstTechnique(const Window& window) { return window.l + 1; }
  static int techniques(const Window& window) {
    return window.l == 0 ? 1 : window.m - firstTechnique(window) + 1;
  }

  // log of the probability P / #j with which the window and the number of edges that take its place are drawn, and one
  // technique to make them.
  double logPlan(const FullPath& path, const Window& window, int added) const;
  bool drawPlan(const FullPath& x, Random& random, Window& window, int& added) const;
  // Grows the vertices of the moved path's window from either side.
  std::optional<Refusal> grow(const Window& window, int j, Random& random);
  // x_0 on a light that is drawn for direct light; the same with a ray from it, and x_1.
  bool drawDirect(Random& random);
  bool drawEmission(Random& random);

  const PathTarget& target_;
  int minLength_;
  PathMove move_;
};

MutationPlugin veachBidirectional();

}  // namespace h2mc
