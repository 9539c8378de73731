// SPDX-License-Identifier: MIT
// Photons: where light subpaths arrive at surfaces, found by their position.
#pragma once

#include <cstdint>
#include <vector>

#include "render/path/primary_sample.h"
#include "render/photon/point_grid.h"
#include "render/photon/wide_lobes.h"
#include "render/scene/scene.h"

namespace h2mc {

struct Photon {
  Vec3f p;
  Vec3f toLight;  // unit, where it has come from
  Vec3f normal;   // geometric, unit, of the surface that it lies on
  Rgbf flux;  // over the number of light subpaths; with what shading normals make of it on the way
  int edges;  // of the light subpath, up to here
};

// The photons of one pass. They are stored where the surface has wide lobes, but for those that come from the light
// straight away: next-event estimation does better there, unless the light is a beam, which it can't find.
class PhotonMap {
 public:
  // Bytes that a stored photon takes in all: in its list, sorted, and what sorting needs.
  static constexpr double kBytesAPhoton = 2 * sizeof(Photon) + 16;
  static constexpr int kMostPaths = 100'000'000;

  // `paths`: light subpaths a pass. `maxDepth`: edges of the longest path, the camera's one included. Keeps
  // references. Precondition: 1 <= paths <= kMostPaths.
  PhotonMap(const Scene& scene, const WideLobes& lobes, int paths, int maxDepth);

  // Traces those of the pass at this moment of the shutter's opening, into cells of this size. A function of seed,
  // pass, time and cell, whatever the number of threads. Reuses the memory of the pass before.
  void trace(std::uint64_t seed, std::uint64_t pass, float time, float cell, int threads);

  const PointGrid<Photon>& photons() const { return grid_; }
  int paths() const { return paths_; }
  // Left out as they were not finite, in this pass.
  long long notFinite() const;

 private:
  struct Group {
    long long notFinite = 0;
  };
  void traceGroup(int group, std::uint64_t seed, std::uint64_t pass, float time);
  void tracePath(Random& random, float lightChoice, float time, std::vector<Photon>& photons,
                 Group& group) const;

  const Scene& scene_;
  const WideLobes& lobes_;
  int paths_, maxDepth_;
  std::vector<Group> groups_;
  std::vector<std::vector<Photon>> lists_;  // of the groups
  PointGrid<Photon> grid_;
};

// r_n / r_1 in pass n, n >= 1: r_(n+1)^2 / r_n^2 = (n + alpha) / (n + 1) [Knaus and Zwicker 2011], so that r_n^2 falls
// as n^(alpha - 1). With 0 < alpha < 1 variance and bias of the mean of all passes go to 0, as n^-alpha and as
// n^(alpha - 1).
double radiusOfPass(long long n, double alpha);

}  // namespace h2mc
