// SPDX-License-Identifier: MIT
// Techniques and the primary sample space that each of them has.
#pragma once

#include <array>
#include <cstdint>

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
// is drawn uniformly whatever the technique, so that it is in no density that MIS compares.
struct PrimarySample {
  std::array<float, 2 * kMaxPathLength> u;
  std::array<float, kMaxPathLength + 1> choice;
  float time = 0;  // the moment of the shutter's opening; 0 in a scene in which nothing moves
};

// Coordinates where 0 and 1 are the same point, as bits.
using CoordinateMask = std::uint64_t;
static_assert(2 * kMaxPathLength <= 64);

}  // namespace h2mc
