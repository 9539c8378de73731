// SPDX-License-Identifier: MIT
#include "mcmc/mutations/veach_bidirectional.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace h2mc {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

double weightAt(int n, int mode) { return std::ldexp(1.0, -std::abs(n - mode)); }

int drawIndex(int count, Random& random) {
  return std::min(static_cast<int>(random.uniformDouble() * count), count - 1);
}

}  // namespace

double VeachBidirectional::Geometric::sum() const {
  double sum = 0;
  for (int n = least; n <= most; ++n) sum += weightAt(n, mode);
  return sum;
}
double VeachBidirectional::Geometric::probability(int n) const { return weightAt(n, mode) / sum(); }
int VeachBidirectional::Geometric::draw(Random& random) const {
  double u = random.uniformDouble() * sum();
  int n = least;
  while (n < most && (u -= weightAt(n, mode)) >= 0) ++n;
  return n;
}

VeachBidirectional::Geometric VeachBidirectional::deletions(int edges, int change) {
  // At least one edge is added; to replace one by one is to do nothing. All edges and the end on the light are edges +
  // 1.
  return {2, std::max(change == 0 ? 2 : 1, 1 - change), edges + 1};
}

bool VeachBidirectional::isWindow(const FullPath& path, int l, int deleted, int added) {
  const int m = l + deleted;
  // Beside a light that is drawn anew there is at least one vertex that stays.
  if (l < 0 && (deleted < 2 || added < 2)) return false;
  return m <= path.edges && (l <= 0 || !path.x[at(l)].delta) &&
         (m == path.edges || !path.x[at(m)].delta);
}

int VeachBidirectional::windows(const FullPath& path, int deleted, int added) const {
  int count = 0;
  for (int l = -1; l + deleted <= path.edges; ++l) count += isWindow(path, l, deleted, added);
  return count;
}

double VeachBidirectional::logPlan(const FullPath& path, const Window& window, int added) const {
  const int deleted = window.edges(), change = added - deleted;
  return std::log(lengths(path.edges).probability(path.edges + change) *
                  deletions(path.edges, change).probability(deleted) /
                  (windows(path, deleted, added) * techniques({window.l, window.l + added})));
}

double VeachBidirectional::logWindow(const FullPath& path, const TechniqueDensities& densities,
                                     const Window& window) const {
  const auto [l, m] = window;
  const double kept = densities.fromCamera[at(m)];
  if (l == 0) return path.x[1].delta ? kNever : densities.fromCamera[1] - kept;
  const double prefix = densities.fromLight[at(l + 1)];  // 0 where nothing is kept
  double sum = 0;
  for (int j = firstTechnique(window); j <= m; ++j) {
    if (!(densities.logDensity[at(j)] > kNever)) continue;
    sum += std::exp(densities.logDensity[at(j)] - prefix - kept);
  }
  return std::log(sum);
}

bool VeachBidirectional::drawPlan(const FullPath& x, Random& random, Window& window,
                                  int& added) const {
  const int change = lengths(x.edges).draw(random) - x.edges;
  const int deleted = deletions(x.edges, change).draw(random);
  added = deleted + change;
  const int count = VeachBidirectional::windows(x, deleted, added);
  if (count == 0) return false;
  int left = drawIndex(count, random);
  for (int l = -1;; ++l) {
    if (!isWindow(x, l, deleted, added) || left-- > 0) continue;
    window = {l, l + deleted};
    return true;
  }
}

bool VeachBidirectional::drawDirect(Random& random) {
  const Scene& scene = target_.scene();
  FullPath& y = move_.path();
  PrimitiveId primitive;
  if (!pickLight(scene, scene.directPicker, random.uniform(), y.light, primitive)) return false;
  const float u = random.uniform();
  setLightPoint(scene, y, primitive, u, random.uniform(), nullptr);
  return true;
}

bool VeachBidirectional::drawEmission(Random& random) {
  const Scene& scene = target_.scene();
  FullPath& y = move_.path();
  PrimitiveId primitive;
  if (!pickLight(scene, scene.emissionPicker, random.uniform(), y.light, primitive)) return false;
  float u[4];
  for (float& coordinate : u) coordinate = random.uniform();
  const PathRay<float> ray =
      startLight<float>(scene, y.light, primitive, u[0], u[1], u[2], u[3], &y.time);
  const Vec3f back = -ray.direction;
  Growth growth{scene, y};
  if (dark(ray.throughput) || !growth.arriveFromLight(ray)) return false;
  setLightPoint(scene, y, primitive, u[0], u[1], &back);
  return true;
}

std::optional<Refusal> VeachBidirectional::grow(const Window& window, int j, Random& random) {
  FullPath& y = move_.path();
  Growth growth{target_.scene(), y};
  const int l = window.l, m = window.m;
  if (l < 0 && j >= 2 && !drawEmission(random)) return Refusal::kStructure;
  // x_l and x_m may not become vertices with delta lobes.
  const auto goOn = [&](int i, Side side) {
    Vec3f direction;
    return growth.scatter(i, side, uniformSample(random), direction) &&
           !((i == l || i == m) && y.x[at(i)].delta) && growth.leave(i, side, direction);
  };
  for (int i = m; i > j; --i) {
    if (i == y.edges) {
      const float filmX = random.uniform();
      if (!growth.leaveEye(filmX, random.uniform())) return Refusal::kStructure;
    } else if (!goOn(i, Side::kCamera)) {
      return Refusal::kStructure;
    }
  }
  for (int i = std::max(l, 1); i < j - 1; ++i)
    if (!goOn(i, Side::kLight)) return Refusal::kStructure;
  if (l < 0 && j == 1 && !drawDirect(random)) return Refusal::kDark;
  if (j == 0) return setLightHit(target_.scene(), y) ? std::nullopt : std::optional(Refusal::kDark);
  return move_.free(j) ? std::nullopt : std::optional(Refusal::kBlocked);
}

Proposal VeachBidirectional::propose(ChainState& current, ChainState& proposed,
                                     MutationContext& context) {
  Random& random = *context.random;
  const PathSpaceState* const from = move_.from(current, context);
  if (!from) return Proposal::none(Refusal::kTechnique);
  const FullPath& x = from->path;
  Window window{};
  int added = 0;
  if (!drawPlan(x, random, window, added)) return Proposal::none(Refusal::kStructure);

  FullPath& y = move_.begin(x);
  const Window anew{window.l, window.l + added};
  y.edges = x.edges + added - window.edges();
  std::copy_n(x.x.begin() + window.m, x.edges - window.m + 1, y.x.begin() + anew.m);
  const int j = firstTechnique(anew) + drawIndex(techniques(anew), random);
  // (1, 1) is no technique, though the eye and a light that stays can see each other.
  if (j == 1 && y.edges == 1 && anew.l < 0) return Proposal::none(Refusal::kTechnique);
  if (const auto refusal = grow(anew, j, random)) return Proposal::none(*refusal);

  const TechniqueDensities& there = move_.arrive();
  const double back = logPlan(y, anew, window.edges()) + logWindow(x, from->densities, window);
  const double forth = logPlan(x, window, added) + logWindow(y, there, anew);
  return move_.finish(current, proposed, back - forth, context);
}

MutationPlugin veachBidirectional() {
  return {"veachBidirectional",
          "a part of the path is deleted and sampled anew from both sides, with another number of "
          "edges perhaps [Veach and Guibas 1997]",
          {},
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<VeachBidirectional>(setup.target, setup.minLength, setup.slots);
          }};
}

}  // namespace h2mc
