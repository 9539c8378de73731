// SPDX-License-Identifier: MIT
#include "render/light/environment_sum.h"

namespace h2mc {
namespace {

// Radiance from a direction.
Rgbf from(const Light& light, const Vec3f& direction) {
  if (const auto* constant = std::get_if<ConstantLight>(&light)) return constant->radiance;
  return std::get<EnvmapLight>(light)
      .hit<float>(LightContext{}, SurfacePoint<float>{}, direction)
      .radiance;
}

std::size_t pixels(const Light& light) {
  const auto* map = std::get_if<EnvmapLight>(&light);
  return map ? map->image().pixels.size() : 0;
}

}  // namespace

Light sumOfEnvironments(const Light& a, const Light& b) {
  if (pixels(a) < pixels(b)) return sumOfEnvironments(b, a);
  if (const auto* constant = std::get_if<ConstantLight>(&a))
    return ConstantLight{{}, constant->radiance + std::get<ConstantLight>(b).radiance};
  const auto& map = std::get<EnvmapLight>(a);
  Image image = map.image();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.at(x, y) += from(b, map.directionOf(x, y));
  return EnvmapLight(image, 1, map.toWorld());
}

}  // namespace h2mc
