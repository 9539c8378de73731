// SPDX-License-Identifier: MIT
#include "mcmc/mutations/lens_subpath.h"

#include <algorithm>

#include "mcmc/mutations/mutation_options.h"

namespace h2mc {

double LensSubpath::logStop(const FullPath& path, int r) const {
  return std::log(nonDeltaProbability(target_.scene(), path, r));
}

std::optional<Refusal> LensSubpath::trace(const FullPath& x, int r, Random& random) {
  const Scene& scene = target_.scene();
  // The eye as far from the light as it can be: how many vertices there will be is not known.
  FullPath& traced = traced_;
  traced.edges = kMaxPathLength;
  traced.parallel = x.parallel;
  traced.view = x.view;
  traced.time = x.time;
  traced.aperture = x.aperture;
  traced.x[kMaxPathLength] = x.eye();
  Growth growth{scene, traced};
  int last = kMaxPathLength - 1;
  const auto edges = [&] { return kMaxPathLength - last + r; };  // of the path that stops here
  const float filmX = random.uniform();
  if (!growth.leaveEye(filmX, random.uniform())) return Refusal::kStructure;
  for (;; --last) {
    if (edges() > target_.maxLength()) return Refusal::kRange;
    const ScatterSample sample = uniformSample(random);
    const bool rough = joinable(scene, traced, last, threshold_);
    Vec3f direction;
    const bool goesOn = growth.scatter(last, Side::kCamera, sample, direction);
    if (rough && !traced.x[at(last)].delta) break;
    if (!goesOn) return Refusal::kDark;
    if (!growth.leave(last, Side::kCamera, direction)) return Refusal::kStructure;
  }
  if (edges() < minLength_) return Refusal::kRange;

  FullPath& y = move_.begin(x);
  y.edges = edges();
  y.filmX = traced.filmX;
  y.filmY = traced.filmY;
  std::copy_n(traced.x.begin() + last, kMaxPathLength - last + 1, y.x.begin() + r);
  if (!joinable(scene, y, r - 1, threshold_)) return Refusal::kStructure;
  return move_.free(r) ? std::nullopt : std::optional(Refusal::kBlocked);
}

Proposal LensSubpath::propose(ChainState& current, ChainState& proposed, MutationContext& context) {
  const PathSpaceState* const from = move_.from(current, context);
  if (!from) return Proposal::none(Refusal::kTechnique);
  const FullPath &x = from->path, &y = move_.path();
  const int r = firstJoinable(x, x.edges);
  if (const auto refusal = trace(x, r, *context.random)) return Proposal::none(*refusal);
  const TechniqueDensities& there = move_.arrive();
  return move_.finish(
      current, proposed,
      from->densities.fromCamera[at(r)] + logStop(x, r) - there.fromCamera[at(r)] - logStop(y, r),
      context);
}

MutationPlugin lensSubpath() {
  static constexpr Parameter kParameters[] = {kRoughnessThresholdParameter};
  return {
      "lensSubpath",
      "the camera's end of the path, up to the first rough vertex, is traced anew from anywhere "
      "on the film [Veach and Guibas 1997]",
      kParameters, [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
        return std::make_unique<LensSubpath>(setup.target, setup.minLength,
                                             roughnessThreshold(setup.options), setup.slots);
      }};
}

}  // namespace h2mc
