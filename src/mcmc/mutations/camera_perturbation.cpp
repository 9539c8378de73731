// SPDX-License-Identifier: MIT
#include "mcmc/mutations/camera_perturbation.h"

namespace h2mc {
namespace {

constexpr double kRadians = M_PI / 180;
constexpr RadialLaw kAngles{0.0001 * kRadians, 0.1 * kRadians};

}  // namespace

CameraPerturbation::CameraPerturbation(const PathTarget& target, float threshold, bool turns,
                                       SlotNumbers& slots)
    : target_(target),
      threshold_(threshold),
      turns_(turns),
      pixels_(pixelsMoved(double(target.scene().film.width) * target.scene().film.height)),
      move_(target, slots) {}

double CameraPerturbation::logDirectionDensity(const FullPath& path,
                                               const TechniqueDensities& densities, int i) const {
  return densities.fromCamera[at(i) - 1] - densities.fromCamera[at(i)] -
         logSpread(target_.scene(), path, i, Side::kCamera);
}

std::optional<Refusal> CameraPerturbation::trace(const FullPath& x, int r, Random& random) {
  const Scene& scene = target_.scene();
  FullPath& y = move_.begin(x);
  Growth growth{scene, y};
  const Vec2f offset = planeOffset(pixels_.draw(random), random);
  const float filmX = x.filmX + offset.x / static_cast<float>(scene.film.width);
  const float filmY = x.filmY + offset.y / static_cast<float>(scene.film.height);
  if (!(filmX >= 0 && filmX < 1 && filmY >= 0 && filmY < 1)) return Refusal::kRange;
  if (!growth.leaveEye(filmX, filmY)) return Refusal::kStructure;
  for (int i = x.edges - 1; i > r; --i) {
    const bool rough = joinable(scene, x, i, threshold_);
    Vec3f direction;
    if (turns_ && rough) {
      float distance;
      direction = turned(directionToLight(x, i, distance), kAngles.draw(random), random);
    } else {
      ScatterSample sample;
      if (!scatterSample(scene, x, i, Side::kCamera, random, sample) ||
          !growth.scatter(i, Side::kCamera, sample, direction))
        return Refusal::kTechnique;
    }
    if (joinable(scene, y, i, threshold_) != rough || !growth.leave(i, Side::kCamera, direction))
      return Refusal::kStructure;
  }
  if (r == 0) return setLightHit(scene, y) ? std::nullopt : std::optional(Refusal::kDark);
  if (!joinable(scene, y, r, threshold_) || !joinable(scene, y, r - 1, threshold_))
    return Refusal::kStructure;
  return move_.free(r) ? std::nullopt : std::optional(Refusal::kBlocked);
}

Proposal CameraPerturbation::propose(ChainState& current, ChainState& proposed,
                                     MutationContext& context) {
  const PathSpaceState* const from = move_.from(current, context);
  if (!from) return Proposal::none(Refusal::kTechnique);
  const FullPath &x = from->path, &y = move_.path();
  int roughVertices;
  const int r = reconnection(x, x.edges, roughVertices);
  if (const auto refusal = trace(x, r, *context.random)) return Proposal::none(*refusal);

  const TechniqueDensities& there = move_.arrive();
  double logMove = from->densities.fromCamera[at(r)] - there.fromCamera[at(r)];
  if (turns_) {
    for (int i = x.edges - 1; i > r; --i)
      if (joinable(target_.scene(), x, i, threshold_))
        logMove += logDirectionDensity(y, there, i) - logDirectionDensity(x, from->densities, i);
  }
  return move_.finish(current, proposed, logMove, context);
}

}  // namespace h2mc
