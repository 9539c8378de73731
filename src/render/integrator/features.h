// SPDX-License-Identifier: MIT
// What camera rays meet first: layers for denoisers and compositors, by a pass of their own.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "render/image/layer.h"

namespace h2mc {

struct Scene;

inline constexpr int kMostFeatureSamples = 65536;

struct FeatureRequest {
  std::vector<LayerKind> layers;  // in the order that is wanted
  int samplesPerPixel = 16;
  std::uint64_t seed = 0;
  int threads = 0;                          // 0: one a core
  const std::atomic<bool>* stop = nullptr;  // set: end when every pixel has a sample
};

// Whether a pass of camera rays makes this layer: all but the variance and the mutations, which are the integrator's.
bool isFeature(LayerKind kind);

// The layers of a request, whose kinds are features. Rays through points of every pixel, of the lens and of the
// shutter's opening that are spread evenly; what they meet is averaged by the film's reconstruction filter. Surfaces
// with an opacity are passed as often as light passes them. By the surface met first:
//
//   albedo    share of white light from everywhere that it scatters to the camera, reflected and transmitted, 0 to 1;
//             what is refracted counts without its change of radiance. 0 where a ray meets nothing
//   normal    shading normal in the world, on the camera's side. Not of unit length where it is a mean; 0 where a ray
//             meets nothing
//   depth     distance from the camera along its axis, in the scene's units; a mean of the rays that meet something,
//             1e10 where there is none
//   position  its place in the world; a mean as that of the depth, 0 where there is none
//   time      the moment at which it is met, in the unit of the shutter and of keyframes; a mean as that of the depth,
//             0 where there is none
//   id        number of the shape that the ray closest to the pixel's centre meets, from 1, in the scene file's order
//             of those that were kept; 0 for nothing
//
// The same for a seed whatever the number of threads. Throws MemoryError.
std::vector<Layer> renderFeatures(const Scene& scene, const FeatureRequest& request);

}  // namespace h2mc
