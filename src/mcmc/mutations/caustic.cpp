// SPDX-License-Identifier: MIT
#include "mcmc/mutations/caustic.h"

#include <algorithm>

#include "mcmc/mutations/mutation_options.h"

namespace h2mc {
namespace {

// Angles stay below this, in radians.
constexpr double kLargestAngle = 1.5;

// In radians; of a parallel camera, in the world's unit.
double sizeOfPixel(const Scene& scene) {
  return std::sqrt(double(scene.camera.filmArea()) /
                   (double(scene.film.width) * scene.film.height));
}

}  // namespace

CausticPerturbation::CausticPerturbation(const PathTarget& target, float threshold,
                                         SlotNumbers& slots)
    : target_(target),
      threshold_(threshold),
      angles_(pixelsMoved(double(target.scene().film.width) * target.scene().film.height)
                  .times(sizeOfPixel(target.scene()))),
      move_(target, slots) {}

RadialLaw CausticPerturbation::lawAt(const FullPath& path, int l) const {
  const int k = path.edges;
  float distance = 1;
  if (!path.parallel) directionToLight(path, k, distance);
  RadialLaw law = angles_.times(distance);
  if (l == 0 && path.infinite) return law;
  double length = 0;
  for (int i = l + 1; i < k; ++i) {
    directionToLight(path, i, distance);
    length += distance;
  }
  law = law.times(1 / length);
  return law.times(std::min(1.0, kLargestAngle / law.largest));
}

double CausticPerturbation::logTraced(const FullPath& path, const TechniqueDensities& densities,
                                      int l) const {
  return logSpread(scene(), path, l + 1, Side::kLight) + densities.fromLight[at(path.edges)] -
         densities.fromLight[at(l) + 2];
}

std::optional<Refusal> CausticPerturbation::trace(const FullPath& x, int l, double r,
                                                  Random& random) {
  FullPath& y = move_.begin(x);
  const int k = x.edges;
  Growth growth{scene(), y};
  if (l == 0 && x.infinite) {
    const Vec2f offset = planeOffset(r, random);
    const Frame<float> frame = Frame<float>::fromNormal(x.escape);
    const float far = 2 * scene().bounds.radius;
    PathRay<float> ray{};
    ray.origin = x.x[1].point.p + frame.toWorld(Vec3f(offset.x, offset.y, far));
    ray.direction = -x.escape;
    if (!growth.arriveFromLight(ray)) return Refusal::kStructure;
  } else {
    float distance;
    const Vec3f direction = turned(-directionToLight(x, l + 1, distance), r, random);
    if (!growth.leave(l, Side::kLight, direction)) return Refusal::kStructure;
  }
  for (int i = l + 1; i < k - 1; ++i) {
    ScatterSample sample;
    Vec3f direction;
    if (!scatterSample(scene(), x, i, Side::kLight, random, sample) ||
        !growth.scatter(i, Side::kLight, sample, direction))
      return Refusal::kTechnique;
    if (!growth.leave(i, Side::kLight, direction)) return Refusal::kStructure;
  }
  // What the eye has before it, and which vertex is the next that can be joined.
  for (int i = k - 1; i >= l; --i)
    if (joinable(scene(), y, i, threshold_) != (i == k - 1 || i == l)) return Refusal::kStructure;
  if (!leadsBack(y, l, r)) return Refusal::kRange;
  return move_.free(k) ? std::nullopt : std::optional(Refusal::kBlocked);
}

Proposal CausticPerturbation::propose(ChainState& current, ChainState& proposed,
                                      MutationContext& context) {
  const PathSpaceState* const from = move_.from(current, context);
  if (!from) return Proposal::none(Refusal::kTechnique);
  const FullPath& x = from->path;
  int l = x.edges - 2;
  while (!joinable(scene(), x, l, threshold_)) --l;
  const double r = lawAt(x, l).draw(*context.random);
  if (const auto refusal = trace(x, l, r, *context.random)) return Proposal::none(*refusal);
  const TechniqueDensities& there = move_.arrive();
  return move_.finish(current, proposed,
                      logTraced(x, from->densities, l) - logTraced(move_.path(), there, l),
                      context);
}

MutationPlugin causticPerturbation() {
  static constexpr Parameter kParameters[] = {kRoughnessThresholdParameter};
  return {"caustic",
          "the last rough vertex before the one that is seen, or the light, sends its light into a "
          "slightly different direction [Veach and Guibas 1997]",
          kParameters, [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<CausticPerturbation>(
                setup.target, roughnessThreshold(setup.options), setup.slots);
          }};
}

}  // namespace h2mc
