// SPDX-License-Identifier: MIT
#include "render/photon/photon_pass.h"

#include <algorithm>
#include <cmath>

#include "render/core/low_discrepancy.h"
#include "render/core/unit_interval.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kTimeStream = 0x74696d65, kPilotStream = 0x70696c6f74;
// Radii are those of pixels at distances from a quarter of the typical one to four times that: nearer ones would meet
// no photons, further ones too many cells.
constexpr float kRange = 4;
// Cosine between the normals of two points of one surface, at least.
constexpr float kSameSurface = 0.7f;
// Photons that a light path leaves, as far as memory is reckoned.
constexpr double kStoredAPath = 5;

float pixelEdge(const Scene& scene) {
  const double pixels = static_cast<double>(scene.film.width) * scene.film.height;
  return static_cast<float>(std::sqrt(static_cast<double>(scene.camera.filmArea()) / pixels));
}

}  // namespace

PhotonPass::PhotonPass(const Scene& scene, const PhotonOptions& options, std::uint64_t seed,
                       int threads)
    : scene_(scene),
      options_(options),
      seed_(seed),
      threads_(threads),
      lobes_(scene.bsdfs, scene.materials, static_cast<float>(options.narrowest)),
      map_(scene, lobes_, options.photons, options.path.maxDepth),
      pixel_(pixelEdge(scene)),
      typical_(typicalDistance()),
      shift_(Random(seed, kTimeStream, 0).uniform()) {}

MemoryItem PhotonPass::memory(const PhotonOptions& options) {
  return {options.photons * kStoredAPath * PhotonMap::kBytesAPhoton,
          std::to_string(options.photons) + " light paths a pass",
          "expected fewer by the option \"photons\""};
}

// The median of some paths.
float PhotonPass::typicalDistance() const {
  constexpr int kGrid = 24;
  const CameraWalk walk(options_.path);
  std::vector<float> distances;
  SampleTally tally;
  WalkedDistance walked;
  for (int cell = 0; cell < kGrid * kGrid; ++cell) {
    Random random(0, kPilotStream, static_cast<std::uint64_t>(cell));
    PrimarySample shared;
    drawShared(scene_.shared(), random, shared);
    const int column = cell % kGrid, row = cell / kGrid;
    const float x = (static_cast<float>(column) + 0.5f) / kGrid;
    const float y = (static_cast<float>(row) + 0.5f) / kGrid;
    walk.radiance(scene_, random, shared.time,
                  startCamera<float>(scene_, x, y, &shared.time, shared.aperture.data()), tally,
                  [&](const PathVertex<float>& vertex, PrimitiveId id, LobeId, int length) {
                    const float distance = walked.to(vertex, length);
                    CameraWalk::Visited visited;
                    visited.last = lobes_.in(scene_.shapes[id.shape].material);
                    if (visited.last) distances.push_back(distance);
                    return visited;
                  });
  }
  if (distances.empty()) return scene_.bounds.radius;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return std::max(*middle, 1e-30f);
}

void PhotonPass::begin(long long pass) {
  pass_ = pass;
  scale_ = radiusOfPass(pass + 1, options_.alpha);
  // Evenly spread over the passes [van der Corput 1935].
  const auto index = static_cast<std::uint64_t>(pass);
  time_ = scene_.moving ? wrap(shift_ + sobolPoint(index).x) : 0;
  map_.trace(seed_, index, time_, 2 * radius(typical_), threads_);
}

float PhotonPass::radius(float distance) const {
  const float pixel = scene_.camera.isParallel()
                          ? pixel_
                          : pixel_ * std::clamp(distance, typical_ / kRange, typical_ * kRange);
  return static_cast<float>(options_.radius * scale_) * pixel;
}

Rgbf PhotonPass::gather(const PathVertex<float>& vertex, PrimitiveId id, int length, float distance,
                        SampleTally& tally) const {
  const int index = scene_.shapes[id.shape].material;
  if (!lobes_.in(index)) return Rgbf(0);
  const Material& material = materialAt(scene_, id);
  const SurfacePoint<float>& point = vertex.point;
  const float reach = radius(distance);
  Rgbf sum(0);
  map_.photons().visit(point.p, reach, [&](const Photon& photon, float) {
    const int edges = length + photon.edges;
    if (edges < options_.path.minDepth || edges > options_.path.maxDepth) return;
    if (!(std::abs(dot(photon.normal, point.ng)) > kSameSurface)) return;
    if (bendBlocks(vertex, photon.toLight, Side::kCamera)) return;
    const Vec3f wo = point.shading.toLocal(photon.toLight);
    const BsdfValue<float> f =
        evaluateMaterial<float>(scene_.bsdfs, material, point.uv, vertex.wi, wo);
    if (!(f.pdf > 0)) return;
    // The photons' density is that of irradiance, with the geometric cosine in it; f's is the shading frame's. The
    // larger one of both points', which are the same in the limit, makes no spikes where surfaces are curved.
    const float cosine = std::max(geometricCosine(point, wo, photon.toLight),
                                  std::abs(dot(photon.normal, photon.toLight)));
    if (!(cosine > 0)) return;
    const float share = lobes_.share(index, material, point.uv, vertex.wi, wo);
    sum += f.value * photon.flux * (share / cosine);
  });
  const Rgbf value = vertex.throughput * sum * (kInvPi / (reach * reach));
  const float all = value.x + value.y + value.z;
  if (all >= 0 && all <= std::numeric_limits<float>::max()) return value;
  ++tally.notFinite;
  return Rgbf(0);
}

nlohmann::json PhotonPass::statistics() const {
  return {{"light paths a pass", map_.paths()},
          {"photons of the last pass", map_.photons().size()},
          {"not finite in the last pass", map_.notFinite()},
          {"typical radius of the first pass", radius(typical_) / scale_},
          {"last radius over the first", scale_}};
}

}  // namespace h2mc
