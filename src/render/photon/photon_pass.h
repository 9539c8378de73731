// SPDX-License-Identifier: MIT
// What the camera paths of one pass gather from: its photons, its radii, its time.
#pragma once

#include <vector>

#include "render/integrator/camera_walk.h"
#include "render/integrator/memory_need.h"
#include "render/photon/photon_map.h"

namespace h2mc {

struct PhotonOptions {
  PathOptions path;
  int photons = 0;    // light subpaths a pass
  double radius = 2;  // of the first pass, in pixels
  double alpha = 2. / 3;
  double narrowest = 0.4;  // of wide lobes, in radians
};

// How far the camera's path has come.
class WalkedDistance {
 public:
  // At the path's vertex after `length` edges; to be called for each in turn.
  float to(const PathVertex<float>& vertex, int length) {
    if (length == 1) {
      sum_ = 0;
      last_ = vertex.line.origin;
    }
    sum_ += glm::distance(last_, vertex.point.p);
    last_ = vertex.point.p;
    return sum_;
  }

 private:
  Vec3f last_{0};
  float sum_ = 0;
};

// Photon mapping in independent passes, each with a map and a radius of its own, of which the picture is the mean
// [Knaus and Zwicker 2011]: the limit of stochastic progressive photon mapping [Hachisuka and Jensen 2009] without its
// statistics, so that passes need nothing of one another.
class PhotonPass {
 public:
  // Keeps a reference to the scene.
  PhotonPass(const Scene& scene, const PhotonOptions& options, std::uint64_t seed, int threads);

  // Pass 0, 1, ..: traces its photons.
  void begin(long long pass);

  // The moment at which all of the pass is: photons and camera paths are only joined at the same one.
  float time() const { return time_; }
  // The radius, in world space, at a vertex that the camera sees along a path of this length.
  float radius(float distance) const;
  // Radiance that photons send on from `vertex`, by its wide lobes, as the camera receives it along its path of
  // `length` edges and this distance [Jensen 1996]: the sum of f_wide * flux over the disk's area, of photons on
  // surfaces that face the same way. What is not finite is counted, and zero.
  Rgbf gather(const PathVertex<float>& vertex, PrimitiveId id, int length, float distance,
              SampleTally& tally) const;

  const WideLobes& lobes() const { return lobes_; }
  const PhotonMap& map() const { return map_; }
  nlohmann::json statistics() const;
  // What it will take, reckoned.
  static MemoryItem memory(const PhotonOptions& options);

 private:
  float typicalDistance() const;

  const Scene& scene_;
  PhotonOptions options_;
  std::uint64_t seed_;
  int threads_;
  WideLobes lobes_;
  PhotonMap map_;
  float pixel_;    // its edge, at distance 1; of parallel cameras, at any
  float typical_;  // distance at which the camera's paths meet photons
  float shift_;    // of the passes' times
  float time_ = 0;
  double scale_ = 1;  // of radii, r_n / r_1
  long long pass_ = 0;
};

}  // namespace h2mc
