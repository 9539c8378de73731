// SPDX-License-Identifier: MIT
#include "render/integrator/features.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "render/core/parallel.h"
#include "render/core/random.h"
#include "render/core/unit_interval.h"
#include "render/integrator/memory_need.h"
#include "render/integrator/splat_list.h"
#include "render/path/path.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStream = 0x66656174;
constexpr int kGroups = 64;                 // that a round's pixels are dealt out to
constexpr long long kMostARound = 1 << 16;  // pixels
constexpr float kNothing = 1e10f;           // depth of what no ray meets, as Blender writes it
// A pixel of which less is covered has no depth: with a filter that has negative lobes the mean would mean nothing.
constexpr float kLeastCovered = 1e-2f;

// What is summed on a film each.
enum Sum { kAlbedoSum, kNormalSum, kPositionSum, kSeenSum, kWeightSum, kSums };

struct FirstHit {
  PrimitiveId id;  // invalid: nothing
  Rgbf albedo{0};
  Vec3f normal{0}, position{0};
  float depth = 0;
};

// The coordinates of one camera ray.
struct CameraSample {
  float filmX, filmY, time;
  std::array<float, 2> aperture;
};

// The share of light that goes on from the vertex in the drawn direction, times what has brought the ray there, divided
// by the density.
Rgbf scattered(const Scene& scene, const PathVertex<float>& vertex, PrimitiveId id, LobeId lobe,
               float u0, float u1) {
  const PathRay<float> on = scatterFrom<float>(scene, vertex, id, lobe, u0, u1, Side::kCamera);
  const Vec3f& n = vertex.point.ng;
  const bool refracted = dot(on.direction, n) * dot(vertex.line.direction, n) > 0;
  return refracted ? scatterFrom<float>(scene, vertex, id, lobe, u0, u1, Side::kLight).throughput
                   : on.throughput;
}

FirstHit firstHit(const Scene& scene, const CameraSample& sample, Random& random) {
  FirstHit hit;
  PathRay<float> ray =
      startCamera<float>(scene, sample.filmX, sample.filmY, &sample.time, sample.aperture.data());
  for (int passed = 0; passed < kMaxPathLength; ++passed) {
    const PrimitiveId id = nextPrimitive(scene, ray, passed == 0, sample.time);
    if (!id.valid()) return hit;
    const PathVertex<float> vertex = arriveAt<float>(scene, ray, id, &sample.time);
    const float u0 = random.uniform(), u1 = random.uniform();
    const LobeId lobe = chooseLobe(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi,
                                   u0, u1, random.uniform());
    if (lobe.null) {
      ray = scatterFrom<float>(scene, vertex, id, lobe, u0, u1, Side::kCamera);
      continue;
    }
    hit.id = id;
    const Rgbf albedo = scattered(scene, vertex, id, lobe, u0, u1);
    if (ad::isFinite(albedo)) hit.albedo = albedo;
    hit.normal = vertex.point.shading.n * (vertex.wi.z < 0 ? -1.f : 1.f);
    const CameraPose<float> pose = scene.camera.poseOf(sample.time, sample.aperture);
    hit.depth = dot(vertex.point.p - pose.position, pose.forward);
    hit.position = vertex.point.p;
    return hit;
  }
  return hit;
}

// The k-th of a sequence of points in five dimensions that are spread evenly however many there are: multiples of the
// powers of 1 / g, g^6 = g + 1 [Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018], from a start
// that is drawn for each pixel.
class Spread {
 public:
  explicit Spread(Random& random) {
    for (double& start : start_) start = random.uniformDouble();
  }
  float operator()(int coordinate, int k) const {
    static const std::array<double, 5> steps = [] {
      constexpr double kRoot = 1.1347241384015194;
      std::array<double, 5> powers{};
      for (std::size_t i = 0; i < powers.size(); ++i)
        powers[i] = std::pow(kRoot, -static_cast<double>(i + 1));
      return powers;
    }();
    const double place = start_[at(coordinate)] + k * steps[at(coordinate)];
    return std::min(kBelowOne, static_cast<float>(place - std::floor(place)));
  }

 private:
  std::array<double, 5> start_{};
};

class FeaturePass {
 public:
  FeaturePass(const Scene& scene, const FeatureRequest& request)
      : scene_(scene), request_(request), width_(scene.film.width), height_(scene.film.height) {
    const auto wants = [&](LayerKind kind) {
      return std::count(request.layers.begin(), request.layers.end(), kind) > 0;
    };
    const bool mean = wants(LayerKind::kDepth) || wants(LayerKind::kTime);
    const bool wanted[kSums] = {wants(LayerKind::kAlbedo), wants(LayerKind::kNormal),
                                wants(LayerKind::kPosition), mean || wants(LayerKind::kPosition),
                                true};
    double bytes = 0;
    for (const bool sum : wanted) bytes += sum ? 12 : 0;
    for (const LayerKind kind : request.layers)
      bytes += 4.0 * static_cast<double>(layerName(kind).channels.size());
    if (wants(LayerKind::kId)) bytes += 8;
    requireMemory({filmMemory(scene.film, bytes),
                   {kMostARound * 48.0 * static_cast<int>(kSums), "camera rays", ""}});
    for (int sum = 0; sum < kSums; ++sum)
      if (wanted[sum]) films_[at(sum)].emplace(scene.film);
    if (wants(LayerKind::kId)) {
      ids_.assign(pixels(), 0);
      distances_.assign(pixels(), std::numeric_limits<float>::infinity());
    }
  }

  std::vector<Layer> run() {
    const long long all = static_cast<long long>(pixels());
    for (int k = 0; k < request_.samplesPerPixel; ++k) {
      if (k > 0 && request_.stop && *request_.stop) break;
      for (long long begin = 0; begin < all; begin += kMostARound)
        round(k, begin, std::min(begin + kMostARound, all));
    }
    std::vector<Layer> layers;
    for (const LayerKind kind : request_.layers) layers.push_back(layer(kind));
    return layers;
  }

 private:
  using Lists = std::array<SplatList, kSums>;

  std::size_t pixels() const { return at(width_) * at(height_); }

  // One sample of each of these pixels.
  void round(int k, long long begin, long long end) {
    const int bands = bandCount(request_.threads, height_);
    parallelFor(request_.threads, kGroups, [&](int group) {
      Lists& lists = lists_[at(group)];
      const long long count = end - begin;
      for (long long i = begin + group * count / kGroups; i < begin + (group + 1) * count / kGroups;
           ++i)
        sample(k, i, lists);
      for (std::size_t sum = 0; sum < kSums; ++sum)
        if (films_[sum]) lists[sum].sort(*films_[sum], bands);
    });
    for (std::size_t sum = 0; sum < kSums; ++sum) {
      if (!films_[sum]) continue;
      std::vector<FilmPart> parts;
      for (Lists& lists : lists_) parts.push_back({&lists[sum], 0});
      addInOrder<float>(parts, request_.threads, *films_[sum]);
    }
  }

  void sample(int k, long long pixel, Lists& lists) {
    const int x = static_cast<int>(pixel % width_), y = static_cast<int>(pixel / width_);
    // Where the pixel's samples begin is the same for all of them.
    Random random(request_.seed, kStream, static_cast<std::uint64_t>(pixel));
    const Spread spread(random);
    Random own(request_.seed, kStream + 1 + at(k), static_cast<std::uint64_t>(pixel));
    const float inX = spread(0, k), inY = spread(1, k);
    const auto place = [](int i, float offset, int size) {
      return std::min(kBelowOne, (static_cast<float>(i) + offset) / static_cast<float>(size));
    };
    CameraSample ray{place(x, inX, width_), place(y, inY, height_), 0, {0.5f, 0.5f}};
    const SharedCoordinates shared = scene_.shared();
    if (shared.time) ray.time = spread(2, k);
    if (shared.aperture) ray.aperture = {spread(3, k), spread(4, k)};
    const FirstHit hit = firstHit(scene_, ray, own);

    const auto add = [&](Sum sum, const Rgbf& value) {
      if (films_[sum]) lists[sum].splat(ray.filmX, ray.filmY, value);
    };
    add(kWeightSum, Rgbf(1, 0, 0));
    if (!ids_.empty()) {
      const float distance = squared(inX - 0.5f) + squared(inY - 0.5f);
      if (distance < distances_[at(pixel)]) {
        distances_[at(pixel)] = distance;
        ids_[at(pixel)] = hit.id.valid() ? hit.id.shape + 1 : 0;
      }
    }
    if (!hit.id.valid()) return;
    add(kAlbedoSum, hit.albedo);
    add(kNormalSum, hit.normal);
    add(kPositionSum, hit.position);
    add(kSeenSum, Rgbf(hit.depth, ray.time, 1));
  }

  Layer layer(LayerKind kind) const {
    Layer layer = makeLayer(kind, pixels());
    parallelFor(request_.threads, height_, [&](int y) {
      for (int x = 0; x < width_; ++x) {
        const Rgbf value = valueAt(kind, x, y);
        const std::size_t i = at(y) * at(width_) + at(x), channels = layer.channels.size();
        for (std::size_t c = 0; c < channels; ++c)
          layer.values[i * channels + c] = value[static_cast<int>(c)];
      }
    });
    return layer;
  }

  Rgbf valueAt(LayerKind kind, int x, int y) const {
    if (kind == LayerKind::kId) return Rgbf(static_cast<float>(ids_[at(y) * at(width_) + at(x)]));
    const auto sum = [&](Sum which) { return films_[which]->pixel(x, y, 1); };
    const float weight = sum(kWeightSum).x;
    const bool any = weight > 0;
    if (kind == LayerKind::kAlbedo)
      return any ? glm::clamp(sum(kAlbedoSum) / weight, 0.f, 1.f) : Rgbf(0);
    if (kind == LayerKind::kNormal) return any ? sum(kNormalSum) / weight : Rgbf(0);
    const Rgbf seen = sum(kSeenSum);
    const bool covered = any && seen.z > kLeastCovered * weight;
    if (kind == LayerKind::kDepth) return Rgbf(covered ? seen.x / seen.z : kNothing);
    if (!covered) return Rgbf(0);
    if (kind == LayerKind::kPosition)
      return Rgbf(glm::dvec3(sum(kPositionSum) / seen.z) + scene_.origin);
    assert(kind == LayerKind::kTime);
    const Camera& camera = scene_.camera;
    return Rgbf(camera.shutterOpen + seen.y / seen.z * (camera.shutterClose - camera.shutterOpen));
  }

  const Scene& scene_;
  const FeatureRequest& request_;
  int width_, height_;
  std::array<std::optional<ShortFilm>, kSums> films_;
  std::array<Lists, kGroups> lists_;
  std::vector<std::uint32_t> ids_;
  std::vector<float> distances_;  // squared, from the pixel's centre, of the ray that the id is of
};

}  // namespace

bool isFeature(LayerKind kind) {
  return kind != LayerKind::kVariance && kind != LayerKind::kMutations;
}

std::vector<Layer> renderFeatures(const Scene& scene, const FeatureRequest& request) {
  if (request.layers.empty()) return {};
  return FeaturePass(scene, request).run();
}

}  // namespace h2mc
