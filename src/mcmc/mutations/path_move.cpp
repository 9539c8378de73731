// SPDX-License-Identifier: MIT
#include "mcmc/mutations/path_move.h"

#include <algorithm>
#include <cmath>

namespace h2mc {

int drawTechnique(const TechniqueDensities& densities, Random& random) {
  double u = random.uniformDouble();
  int drawn = -1;  // the last that there is, should rounding leave something
  for (int s = 0; s <= densities.edges; ++s) {
    const double weight = densities.weight[at(s)];
    if (!(weight > 0)) continue;
    drawn = s;
    if ((u -= weight) < 0) break;
  }
  return drawn;
}

const PathSpaceState* PathMove::from(ChainState& current, MutationContext& context) {
  const PathSpaceState& x = pathSpaceAt(target_.scene(), current, pathSpace_);
  auto& [assembles, known] = current.derived[assembles_];
  if (!known) {
    known = true;
    const int i = current.path.technique.s;
    assembles.inItsTechnique =
        x.densities.weight[at(i)] > 0 && assemble(target_.scene(), x.path, current.path.technique,
                                                  kNoEdge, *context.random, work_->back);
  }
  return assembles.inItsTechnique ? &x : nullptr;
}

FullPath& PathMove::begin(const FullPath& x) {
  FullPath& to = work_->to;
  to.edges = x.edges;
  std::copy_n(x.x.begin(), x.edges + 1, to.x.begin());
  to.light = x.light;
  to.lightPrimitive = x.lightPrimitive;
  to.infinite = x.infinite;
  to.escape = x.escape;
  to.parallel = x.parallel;
  to.view = x.view;
  to.filmX = x.filmX;
  to.filmY = x.filmY;
  to.time = x.time;
  to.aperture = x.aperture;
  return to;
}

const TechniqueDensities& PathMove::arrive() {
  work_->there = densities(target_.scene(), work_->to);
  return work_->there;
}

Proposal PathMove::finish(ChainState& current, ChainState& proposed, double logMove,
                          MutationContext& context) {
  const FullPath& to = work_->to;
  const TechniqueDensities& there = work_->there;
  const PathSpaceState& from = pathSpaceAt(target_.scene(), current, pathSpace_);
  // What a beam falls on is where it is, exactly: densities by area mean nothing there.
  if (to.light == from.path.light && isBeam(target_.scene().lights[at(to.light)]) &&
      to.x[1].point.p != from.path.x[1].point.p)
    return Proposal::none(Refusal::kStructure);
  if (!(luminance(there.color) > 0)) return Proposal::none(Refusal::kDark);
  const int j = drawTechnique(there, *context.random);
  if (j < 0 || !std::isfinite(logMove)) return Proposal::none(Refusal::kTechnique);
  const Technique technique{j, to.edges + 1 - j};
  if (!assemble(target_.scene(), to, technique, kNoEdge, *context.random, proposed.path))
    return Proposal::none(Refusal::kTechnique);
  if (!target_.weigh(proposed.path)) return Proposal::none(Refusal::kDark);
  proposed.derived[assembles_] = {{true}, true};
  const TechniqueDensities& here = from.densities;
  const int i = current.path.technique.s;
  return Proposal::withLogRatio(logMove + there.logDensity[at(j)] - here.logDensity[at(i)] +
                                std::log(here.weight[at(i)] / there.weight[at(j)]));
}

}  // namespace h2mc
