// SPDX-License-Identifier: MIT
// Veach's law for how far a perturbation goes: uniform on a logarithmic scale between two bounds.
#pragma once

#include <cmath>

#include "render/core/frame.h"
#include "render/core/random.h"
#include "render/core/types.h"

namespace h2mc {

// Distances, or angles, r = largest exp(-ln(largest / smallest) xi) with xi uniform in [0, 1), in a direction that is
// uniform on the circle [Veach and Guibas 1997, section 5]. On a plane its density per area is
// 1 / (2 pi r^2 ln(largest / smallest)), on the sphere per solid angle with sin(r) instead of one r: it is a function
// of r alone, so that it cancels against the way back's where both have the same ratio of bounds, and the way back
// exists.
struct RadialLaw {
  double smallest, largest;

  double draw(Random& random) const {
    return largest * std::exp(-std::log(largest / smallest) * random.uniformDouble());
  }
  // Whether it can draw r.
  bool reaches(double r) const { return r >= smallest && r <= largest; }
  RadialLaw times(double factor) const { return {smallest * factor, largest * factor}; }
};

// A vector of that length in the plane.
inline Vec2f planeOffset(double r, Random& random) {
  const double phi = 2 * M_PI * random.uniformDouble();
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi))};
}

// A unit vector at the angle theta, in radians, from a unit vector.
inline Vec3f turned(const Vec3f& direction, double theta, Random& random) {
  const Vec2f side = planeOffset(std::sin(theta), random);
  const Frame<float> frame = Frame<float>::fromNormal(direction);
  return normalize(frame.toWorld(Vec3f(side.x, side.y, static_cast<float>(std::cos(theta)))));
}

// Bounds of a lens perturbation in pixels, of a film of so many: from a tenth of a pixel to the radius of a disk of a
// twentieth of the film [Veach and Guibas 1997, section 5].
inline RadialLaw pixelsMoved(double pixels) { return {0.1, std::sqrt(0.05 * pixels / M_PI)}; }

}  // namespace h2mc
