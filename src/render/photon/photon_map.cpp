// SPDX-License-Identifier: MIT
#include "render/photon/photon_map.h"

#include <cmath>

#include "render/core/unit_interval.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/path.h"

namespace h2mc {
namespace {

// Apart from the camera paths' numbers.
constexpr std::uint64_t kStream = 0x70686f746f6e;

float largest(const Rgbf& c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

double radiusOfPass(long long n, double alpha) {
  // The product is Gamma(n + alpha) / (Gamma(1 + alpha) n!).
  const auto x = static_cast<double>(n);
  return std::exp(0.5 * (std::lgamma(x + alpha) - std::lgamma(1 + alpha) - std::lgamma(x + 1)));
}

PhotonMap::PhotonMap(const Scene& scene, const WideLobes& lobes, int paths, int maxDepth)
    : scene_(scene), lobes_(lobes), paths_(paths), maxDepth_(maxDepth) {
  const int groups = groupCount(paths);
  static_assert(kMostGroups <= static_cast<int>(PointGrid<Photon>::kMostLists));
  groups_.resize(at(groups));
  lists_.resize(at(groups));
}

long long PhotonMap::notFinite() const {
  long long sum = 0;
  for (const Group& group : groups_) sum += group.notFinite;
  return sum;
}

void PhotonMap::trace(std::uint64_t seed, std::uint64_t pass, float time, float cell, int threads) {
  parallelFor(threads, static_cast<int>(groups_.size()),
              [&](int group) { traceGroup(group, mixBits(seed ^ kStream), pass, time); });
  grid_.build(lists_, cell, threads);
}

void PhotonMap::traceGroup(int index, std::uint64_t seed, std::uint64_t pass, float time) {
  Group& group = groups_[at(index)];
  std::vector<Photon>& photons = lists_[at(index)];
  photons.clear();
  group.notFinite = 0;
  const auto groups = static_cast<long long>(groups_.size()), all = static_cast<long long>(paths_);
  for (long long i = index * all / groups; i < (index + 1) * all / groups; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i), pass);
    // Each light, and each of its primitives, gets its share of the pass.
    const double choice = (static_cast<double>(i) + random.uniformDouble()) / paths_;
    tracePath(random, toUnitInterval(choice), time, photons, group);
  }
}

void PhotonMap::tracePath(Random& random, float lightChoice, float time,
                          std::vector<Photon>& photons, Group& group) const {
  int light;
  PrimitiveId primitive;
  if (!pickLight(scene_, scene_.emissionPicker, lightChoice, light, primitive)) return;
  const float u0 = random.uniform(), u1 = random.uniform();
  const float v0 = random.uniform(), v1 = random.uniform();
  const int least = isBeam(scene_.lights[at(light)]) ? 1 : 2;
  if (least >= maxDepth_) return;
  PathRay<float> ray = startLight<float>(scene_, light, primitive, u0, u1, v0, v1, &time);
  const float share = 1 / static_cast<float>(paths_);
  for (int edges = 1; edges < maxDepth_; ++edges) {
    const float before = largest(ray.throughput);
    if (!(before > 0)) return;
    if (!(before <= std::numeric_limits<float>::max())) {
      ++group.notFinite;
      return;
    }
    const PrimitiveId id = nextPrimitive(scene_, ray, false, time);
    if (!id.valid()) return;
    const PathVertex<float> vertex = arriveAt<float>(scene_, ray, id, &time);
    if (edges >= least && lobes_.in(scene_.shapes[id.shape].material))
      photons.push_back(
          {vertex.point.p, -ray.direction, vertex.point.ng, vertex.throughput * share, edges});
    if (edges + 1 >= maxDepth_) return;
    const float s0 = random.uniform(), s1 = random.uniform();
    const LobeId lobe = chooseLobe(scene_.bsdfs, materialAt(scene_, id), vertex.point.uv, vertex.wi,
                                   s0, s1, random.uniform());
    ray = scatterFrom<float>(scene_, vertex, id, lobe, s0, s1, Side::kLight);
    // Photons of equal flux are worth most: what is absorbed ends paths instead.
    const float survival = std::min(1.f, largest(ray.throughput) / before);
    if (!(random.uniform() < survival)) return;
    ray.throughput *= 1 / survival;
  }
}

}  // namespace h2mc
