// SPDX-License-Identifier: MIT
// A path with all that is known of it: primary sample, topology, vertices, contribution.
#pragma once

#include <algorithm>
#include <vector>

#include "render/path/connect.h"
#include "render/path/primary_sample.h"

namespace h2mc {

class Archive;

struct TracedVertex {
  PathVertex<float> vertex;
  PrimitiveId id;
  LobeId lobe;  // through which the subpath went on; meaningless at its last vertex
};

// Allocates once; tracing reuses it.
struct Path {
  explicit Path(int maxLength)
      : camera(static_cast<std::size_t>(maxLength) + 2),
        light(static_cast<std::size_t>(maxLength) + 2) {}

  Technique technique;
  PrimarySample sample;

  // Topology and vertices. camera[i], i = 1 .. t - 1, is the i-th vertex after the eye; light[i],
  // i = 1 .. s - 1, the i-th after the one on the light.
  std::vector<TracedVertex> camera, light;
  int lightIndex = -1;         // the light that the path starts from or hits
  PrimitiveId lightPrimitive;  // the choice made within it (s >= 1)
  bool escaped = false;      // s = 0 and the last edge leaves the scene: camera[t - 1] is not there
  PathRay<float> lastRay;    // that edge, or the one that has hit a light
  CoordinateMask wraps = 0;  // coordinates that are angles, or that nothing depends on
  bool moving = false;       // anything that it touches moves: it depends on sample.time
  bool aperture = false;     // the camera has a lens: it depends on sample.aperture

  // Result.
  float filmX = 0, filmY = 0;
  Rgbf contribution{0};  // MIS weighted, over the technique's density in its primary space
  float target = 0;      // luminance of the contribution; what a chain samples in proportion to
  bool finite = true;    // false: not finite, or negative; contribution and target are then zero

  void archive(Archive& archive);

  SharedCoordinates shared() const { return {aperture, moving}; }
  // Continuous coordinates that it depends on: the technique's, then the shared ones.
  int dimension() const { return technique.dimension() + shared().count(); }
  // Where the aperture's two and time are among them, if there.
  int apertureCoordinate() const { return technique.dimension(); }
  int timeCoordinate() const { return technique.dimension() + (aperture ? 2 : 0); }
};

// Coordinates of the longest path there is.
inline constexpr int kMaxCoordinates = 2 * kMaxPathLength + kMostShared;

// The path.dimension() coordinates that it is at.
template <class S>
void pathCoordinates(const Path& path, S* u) {
  std::copy_n(path.sample.u.begin(), path.technique.dimension(), u);
  getShared(path.shared(), path.sample, u + path.technique.dimension());
}

// Traces `path.technique` at `path.sample` and fills in the rest. Returns target > 0.
// Never allocates. Precondition: technique.length() <= the path's maxLength.
bool tracePath(const Scene& scene, Path& path);

// The steps of tracePath, for mutations that keep a part of the path and for samplers that join many
// pairs of vertices. The first three return whether the path can still contribute.

// Traces the camera subpath's vertices from index `first` on (1: from the eye); those before stand.
bool traceCamera(const Scene& scene, Path& path, int first = 1);
bool traceLight(const Scene& scene, Path& path);
// Joins the subpaths, tests visibility, and fills in the result.
bool joinSubpaths(const Scene& scene, Path& path);

enum class Step { kArrived, kEscaped, kDead };
// Goes on to camera vertex `i` from the one before (1: from the eye), or to light vertex `i` (1: from
// the light, whose choice has been made by pickLight). kEscaped leaves the edge in path.lastRay.
Step stepCamera(const Scene& scene, Path& path, int i);
Step stepLight(const Scene& scene, Path& path, int i);
// Whether any of the path's vertices, its light or the camera moves.
bool touchesMotion(const Scene& scene, const Path& path);
// The light and its primitive by path.sample's choice coordinate, with the scene's directPicker (s = 1)
// or emissionPicker (s >= 2); false when there is no light.
bool pickLight(const Scene& scene, const LightPicker& picker, float choice, int& light,
               PrimitiveId& primitive);
// The primitive alone, of a light that is known.
PrimitiveId pickPrimitive(const Scene& scene, int light, float choice);

// What a technique's last step needs; members that the technique lacks are not looked at.
struct Ends {
  Technique technique;
  const TracedVertex* camera;   // the camera subpath's last vertex; null: escaped
  const TracedVertex* light;    // s >= 2
  const PathRay<float>* ray;    // the edge that escaped
  int lightIndex;               // s >= 1
  PrimitiveId lightPrimitive;   // s = 1
  float u0, u1;                 // s = 1
  const PrimarySample* sample;  // for what techniques share
};
struct Joined {
  Rgbf contribution{0};
  float filmX = 0, filmY = 0;  // set for t = 1
  bool finite = true;
};
// Contribution with MIS weight and visibility; zero where there is none.
Joined join(const Scene& scene, const Ends& ends);

// Shadow rays: whether `point` sees the light along its direct sample.
bool lightVisible(const Scene& scene, const SurfacePoint<float>& point, int light,
                  const DirectLight<float>& direct, float time);
// Whether the camera sees `point`, and where on the film: from its near clipping plane on, as its rays do.
bool cameraVisible(const Scene& scene, const SurfacePoint<float>& point, float time,
                   const std::array<float, 2>& aperture, float& filmX, float& filmY);

bool pointEscapes(const Scene& scene, const SurfacePoint<float>& point, const Vec3f& direction,
                  float time);
bool pointsVisible(const Scene& scene, const SurfacePoint<float>& a, const SurfacePoint<float>& b,
                   float time);

// The first primitive along a ray; rays from the camera end at its clipping planes.
PrimitiveId nextPrimitive(const Scene& scene, const PathRay<float>& ray, bool fromCamera,
                          float time);

// While one exists with `on`, the seconds that this thread spends in Embree are added up. Not nested.
class RaySeconds {
 public:
  explicit RaySeconds(bool on);
  ~RaySeconds();
  RaySeconds(const RaySeconds&) = delete;
  RaySeconds& operator=(const RaySeconds&) = delete;
  double seconds() const { return seconds_; }

 private:
  double seconds_ = 0;
};

}  // namespace h2mc
