// SPDX-License-Identifier: MIT
// With which density each technique makes a path: the sampling densities behind the MIS weights, for a path
// that is known as a whole [Veach 1997, sections 9.2 and 10.2].
#pragma once

#include "render/path/full_path.h"

namespace h2mc {

// A path's measurement contribution f and the densities p_s of all techniques (s, t), s = 0 .. k,
// t = k + 1 - s, with respect to the measure mu: areas of x_0 .. x_(k-1), for an infinite light the solid
// angle of its edge instead of the area of x_0, nothing for the position of a point light. All non-delta
// lobes of a vertex count together, and the picks of light and primitive are in it.
//
// A vertex with a delta lobe enters mu as if light were scattered there into the solid angle that
// it has towards the camera, with the lobe's probability as density: p_s of one path in different
// techniques, and f / p_s, are exact. Densities of two different paths that have delta vertices can be
// compared where both are made by the same chains, seen from the camera; a change of mu's own scale (the
// derivative of the next point by the direction before the chain) is then in both p_s and proposal density.
struct TechniqueDensities {
  int edges = 0;
  // log p_s; -inf where the technique cannot make the path: delta vertices beside the connection, lights
  // that cannot be hit, (1, 1), which is not a technique.
  std::array<double, kMaxPathLength + 1> logDensity;
  // What it is the sum of: logs of the densities with which x_s .. x_(k-1) are made from the camera, and x_0 .. x_(s-1)
  // from the light (s = 1: as a direct sample), whether or not the two can then be joined. Densities of a part of a
  // subpath are differences of these.
  std::array<double, kMaxPathLength + 1> fromCamera, fromLight;
  // MIS weights, power heuristic with exponent 2: their sum is 1, or 0 if no technique makes the path.
  std::array<double, kMaxPathLength + 1> weight;
  // f = color * exp(logScale). One function of the path, whatever end it is traced from.
  Rgb<double> color{0};
  double logScale = 0;

  // f / p_s * weight: Path::contribution of technique s (with what float rounding makes of it), and its luminance.
  Rgbf contribution(int s) const;
  double target(int s) const;
  // log of the luminance of f / p_s: of the contribution without MIS weight.
  double logUnweighted(int s) const;
};

// log of what turns a density per solid angle, at the end of the edge between x_(i-1) and x_i that a ray of this side
// leaves, into one per area at the other end; for a ray from infinity, per area across the ray.
double logSpread(const Scene& scene, const FullPath& path, int i, Side side);

// Evaluates each material once. Visibility is taken for granted.
TechniqueDensities densities(const Scene& scene, const FullPath& path);

}  // namespace h2mc
