// SPDX-License-Identifier: MIT
// What lights return, and what they know of the scene.
//
// The densities are the ones that the recursive MIS weights of bidirectional path tracing need
// [Georgiev 2012, "Implementing Vertex Connection and Merging"].
#pragma once

#include <limits>
#include <span>

#include "render/geometry/shape.h"
#include "render/geometry/surface_point.h"

namespace h2mc {

// A sphere around everything in the scene.
struct SceneBounds {
  Vec3f center{0};
  float radius = 1;
};

// A disc infinitely far, such as the sun's.
struct SkyDisc {
  Vec3f direction;  // unit, to its centre
  float height;     // 1 - cos of its angular radius

  // 1 - cos of the angle to the centre, without the cancellation.
  float heightOf(const Vec3f& toLight) const {
    const Vec3f d = toLight - direction;
    return dot(d, d) * 0.5f;
  }
  bool covers(const Vec3f& toLight) const { return heightOf(toLight) <= height; }
};

// What a light may ask of the scene it stands in.
struct LightContext {
  std::span<const Shape> shapes;
  SceneBounds bounds;
  std::span<const SkyDisc> suns = {};  // before the environment (sun_light.h)
};

// On the dark side of a light the radiance and emissionPdf are zero, and directPdf is that of the
// direction. Where not even a direction exists (the reference point is the sampled one) directPdf is
// zero too. Everything is finite.
template <class T>
struct DirectLight {
  Vec3<T> direction;  // unit, from the reference point to the light
  T distance;         // to the light; a value beyond the scene for infinite lights
  // What arrives: radiance / directPdf, in closed form. What both have in common is not left to rounding.
  Rgb<T> arriving;
  T directPdf;    // per solid angle at the reference point; distance^2 for point and spot lights, 1
                  // for directional ones, whose radiance here is their intensity or irradiance
  T emissionPdf;  // with which sampleEmission makes this ray: per area and solid angle; for a point
                  // light per solid angle, for a directional one per area
  T cosLight;     // |cos| between the light's geometric normal and the ray; 1 without a surface
  // For the shadow ray, values only: the sampled point (unless the light is infinite) and its
  // surface's geometric normal, zero without a surface.
  Vec3<Scalar<T>> position{0};
  Vec3<Scalar<T>> normal{0};
};

template <class T>
struct EmittedRay {
  Vec3<T> origin;
  Vec3<T> direction;  // unit
  Vec3<T> normal;     // of the emitting surface, for offsetting the ray; zero without a surface
  Rgb<T>
      flux;  // that the ray carries: radiance (intensity, irradiance) times cosLight / emissionPdf, in
             // closed form
  T emissionPdf;  // as above
  T directPdf;    // of the origin as a direct sample: per area for area lights (1 / area), per
                  // solid angle for infinite ones, 1 for delta lights
  T cosLight;
};

template <class T>
struct LightHit {
  Rgb<T> radiance;
  T directPdf;    // per area for area lights, per solid angle for environments
  T emissionPdf;  // per area and solid angle
};

}  // namespace h2mc
