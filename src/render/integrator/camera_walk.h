// SPDX-License-Identifier: MIT
// A path from the camera with next-event estimation at each vertex, weighted by the power heuristic [Veach 1997,
// ch. 9]: all of path tracing, and the camera's part of photon mapping.
#pragma once

#include <algorithm>
#include <limits>

#include "render/core/random.h"
#include "render/integrator/sampling_integrator.h"
#include "render/path/path.h"

namespace h2mc {

struct PathOptions {
  int minDepth = 1, maxDepth = kMaxPathLength;  // in edges
  int rrDepth = 5;                              // length from which Russian roulette may end a path
};

class CameraWalk {
 public:
  // What is done at a vertex besides.
  struct Visited {
    Rgbf radiance{0};  // to be added
    bool last =
        false;  // the walk goes on to see whether the next edge finds a light, and no further
  };

  explicit CameraWalk(const PathOptions& options) : options_(options) {}

  // Radiance along `ray`, which leaves the camera, an estimate. At each vertex from which the path goes on
  // `visit(const PathVertex<float>&, PrimitiveId, LobeId, int length)` is called, returning Visited: with the lobe
  // through which it does and the edges so far.
  template <class Visit>
  Rgbf radiance(const Scene& scene, Random& random, float time, PathRay<float> ray,
                SampleTally& tally, Visit&& visit) const {
    Rgbf radiance(0);
    bool last = false;
    for (int length = 1;; ++length) {
      // s = 0, t = length + 1
      const PrimitiveId id = nextPrimitive(scene, ray, length == 1, time);
      const bool counts = length >= options_.minDepth;
      if (!id.valid()) {
        if (counts && scene.hasEnvironment())
          radiance += finiteOrCounted(
              hitEnvironment<float>(scene, ray, length + 1, kUnidirectional), tally);
        return radiance;
      }
      const PathVertex<float> vertex = arriveAt<float>(scene, ray, id, &time);
      const int light = scene.shapes[id.shape].light;
      if (counts && light >= 0)
        radiance += finiteOrCounted(hitAreaLight<float>(scene, vertex, ray.direction, light,
                                                        length + 1, kUnidirectional, id, &time),
                                    tally);
      if (length == options_.maxDepth || last) return radiance;
      // s = 1, a path one edge longer
      if (length + 1 >= options_.minDepth)
        radiance += direct(scene, random, time, vertex, id, tally);
      const float u0 = random.uniform(), u1 = random.uniform();
      const LobeId lobe = chooseLobe(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi,
                                     u0, u1, random.uniform());
      const Visited visited = visit(vertex, id, lobe, length);
      radiance += visited.radiance;
      last = visited.last;
      ray = scatterFrom<float>(scene, vertex, id, lobe, u0, u1, Side::kCamera);
      const float largest = std::max({ray.throughput.x, ray.throughput.y, ray.throughput.z});
      if (!(largest > 0)) return radiance;
      if (length >= options_.rrDepth) {
        const float survival = std::min(0.95f, largest);
        if (random.uniform() >= survival) return radiance;
        ray.throughput *= 1 / survival;
      }
    }
  }

 private:
  static constexpr auto kUnidirectional = Techniques::kUnidirectional;

  static Rgbf finiteOrCounted(const Contribution<float>& c, SampleTally& tally) {
    const Rgbf value = c.value * c.weight;
    const float sum = value.x + value.y + value.z;
    if (sum >= 0 && sum <= std::numeric_limits<float>::max()) return value;
    ++tally.notFinite;
    return Rgbf(0);
  }

  static Rgbf direct(const Scene& scene, Random& random, const float time,
                     const PathVertex<float>& vertex, PrimitiveId id, SampleTally& tally) {
    int light;
    PrimitiveId primitive;
    const float choice = random.uniform(), u0 = random.uniform(), u1 = random.uniform();
    if (!hasNonDelta(scene.bsdfs, materialAt(scene, id)) ||
        !pickLight(scene, scene.directPicker, choice, light, primitive))
      return Rgbf(0);
    DirectLight<float> sample;
    const Rgbf value =
        finiteOrCounted(connectToLight<float>(scene, vertex, id, light, primitive, u0, u1,
                                              kUnidirectional, sample, &time),
                        tally);
    const bool contributes = value.x > 0 || value.y > 0 || value.z > 0;
    return contributes && lightVisible(scene, vertex.point, light, sample, time) ? value : Rgbf(0);
  }

  PathOptions options_;
};

}  // namespace h2mc
