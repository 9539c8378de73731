// SPDX-License-Identifier: MIT
// Techniques and the primary sample space that each of them has.
#pragma once

#include <array>
#include <cstdint>

#include "render/core/random.h"
#include "render/core/shared_coordinates.h"
#include "render/core/types.h"

namespace h2mc {

// Technique (s, t): s vertices from the light, t from the camera (the eye counted), joined by an
// edge. Path length s + t - 1 edges. t >= 1, s >= 0, (s, t) != (1, 1).
struct Technique {
  int s = 0;
  int t = 2;

  int length() const { return s + t - 1; }
  // Continuous primary coordinates: two an edge, whatever the technique.
  int dimension() const { return 2 * length(); }
  // Where the light subpath's coordinates start: the camera's come first.
  int lightOffset() const { return t >= 2 ? 2 * (t - 1) : 0; }
  int cameraScatterings() const { return t > 2 ? t - 2 : 0; }
  int lightScatterings() const { return s > 2 ? s - 2 : 0; }
  // Choice coordinates: a lobe for each scattering, and the light.
  int choices() const { return cameraScatterings() + (s >= 1) + lightScatterings(); }
  // Which coordinates belong to the scattering at the i-th vertex after the eye or the light, i >= 1.
  int cameraCoordinate(int i) const { return 2 * i; }
  int lightCoordinate(int i) const { return lightOffset() + 2 + 2 * i; }
  int cameraChoice(int i) const { return i - 1; }
  int lightPick() const { return cameraScatterings(); }
  int lightChoice(int i) const { return cameraScatterings() + i; }

  bool operator==(const Technique&) const = default;
};

// A point of a technique's primary space, all coordinates in [0, 1). `u` holds the continuous ones:
// the film position and two for each scattering of the camera subpath; then, for s = 1, two that
// place the point on the light, for s >= 2 four that place and direct the emitted ray and two for
// each scattering. `choice` holds the discrete decisions: lobes, and the light with its primitive.
// Where anything in the scene moves, `time` is one more continuous coordinate, of every technique: it
// is drawn uniformly whatever the technique, so that it is in no density that MIS compares. A camera with a lens has
// two more of that kind: where the path goes through the aperture.
struct PrimarySample {
  std::array<float, 2 * kMaxPathLength> u;
  std::array<float, kMaxPathLength + 1> choice;
  std::array<float, 2> aperture{0.5f, 0.5f};  // its centre for a pinhole
  float time = 0;  // the moment of the shutter's opening; 0 in a scene in which nothing moves
};

// Copies the shared coordinates, there.count() numbers, from a sample and into one.
template <class S>
void getShared(const SharedCoordinates& there, const PrimarySample& sample, S* x) {
  if (there.aperture)
    for (const float a : sample.aperture) *x++ = S(a);
  if (there.time) *x = S(sample.time);
}
inline void setShared(const SharedCoordinates& there, const float* x, PrimarySample& sample) {
  if (there.aperture)
    for (float& a : sample.aperture) a = *x++;
  if (there.time) sample.time = *x;
}

// Coordinates where 0 and 1 are the same point, as bits.
using CoordinateMask = std::uint64_t;
static_assert(2 * kMaxPathLength <= 64);

// Draws those that there are; sets the others to what they are where they make no difference.
inline void drawShared(const SharedCoordinates& there, Random& random, PrimarySample& sample) {
  sample.aperture = {0.5f, 0.5f};
  if (there.aperture)
    for (float& a : sample.aperture) a = random.uniform();
  sample.time = there.time ? random.uniform() : 0;
}

}  // namespace h2mc
