// SPDX-License-Identifier: MIT
#include "mcmc/mutations/technique_change.h"

#include <cmath>

#include "render/path/assemble.h"

namespace h2mc {

Proposal TechniqueChange::propose(ChainState& current, ChainState& proposed,
                                  MutationContext& context) {
  const Scene& scene = target_.scene();
  Random& random = *context.random;
  const PathSpaceState& from = pathSpaceAt(scene, current, pathSpace_);
  const auto& weights = from.densities.weight;
  const int i = current.path.technique.s, edges = from.path.edges;
  // 1 - w_s, where w_s may be 1 but for rounding.
  const auto allBut = [&](int s) {
    double sum = 0;
    for (int r = 0; r <= edges; ++r) sum += r == s ? 0 : weights[at(r)];
    return sum;
  };
  const double others = allBut(i);
  if (!(others > 0)) return Proposal::none();

  double u = random.uniformDouble() * others;
  int j = -1;
  for (int s = 0; s <= edges; ++s) {
    if (s == i || !(weights[at(s)] > 0)) continue;
    j = s;
    if ((u -= weights[at(s)]) < 0) break;
  }
  if (j < 0 || random.uniformDouble() * allBut(j) >= others) return Proposal::none();

  // Where rounding keeps one of the two techniques from having the path, neither way is open.
  Path& to = proposed.path;
  if (!assemble(scene, from.path, {j, edges + 1 - j}, kNoEdge, random, to) || !target_.weigh(to))
    return Proposal::none();
  const PathSpaceState& there = pathSpaceAt(scene, proposed, pathSpace_);
  if (!assemble(scene, there.path, {i, edges + 1 - i}, kNoEdge, random, back_))
    return Proposal::none();
  // The techniques are drawn with w_j min(1 / (1 - w_i), 1 / (1 - w_j)) and the same the other way round.
  const auto& density = from.densities.logDensity;
  return Proposal::withLogRatio(density[at(j)] - density[at(i)] +
                                std::log(weights[at(i)] / weights[at(j)]));
}

MutationPlugin techniqueChange() {
  return {"technique",
          "the path stays, its technique is drawn anew by the MIS weights [Bitterli et al. 2017]",
          {},
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<TechniqueChange>(setup.target, setup.slots);
          }};
}

}  // namespace h2mc
