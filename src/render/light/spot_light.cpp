// SPDX-License-Identifier: MIT
#include "render/light/spot_light.h"

#include <cmath>

namespace h2mc {

SpotLight::SpotLight(const Vec3f& place, const Vec3f& axis, const Rgbf& intensity, float cutoff,
                     float beam)
    : LightAtPoint{{}, place},
      axis_(axis),
      intensity_(intensity),
      cutoff_(glm::radians(cutoff)),
      beam_(glm::radians(beam)),
      cosCutoff_(std::cos(cutoff_)),
      cosBeam_(std::cos(beam_)) {
  // 1 - cos without cancellation.
  const float half = std::sin(cutoff_ / 2);
  conePdf_ = 1 / (4 * kPi * half * half);
}

void SpotLight::project(TexturePtr texture, const Vec3f& x, const Vec3f& y) {
  texture_ = std::move(texture);
  x_ = x;
  y_ = y;
  tanCutoff_ = std::tan(cutoff_);
}

float SpotLight::power(const SceneBounds&) const {
  // The integral of the falloff over the cone: 2 pi (1 - (sin c - sin b) / (c - b)).
  const double c = static_cast<double>(cutoff_), b = static_cast<double>(beam_);
  const double slope = c - b > 1e-4 ? (std::sin(c) - std::sin(b)) / (c - b) : std::cos((c + b) / 2);
  return static_cast<float>(2 * std::numbers::pi * (1 - slope)) *
         luminance(texture_ ? intensity_ * average(*texture_) : intensity_);
}

bool SpotLight::invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin,
                               const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const {
  u = Vec2f(0.5f);
  choice = 0.5f;
  const Vec3f local = Frame<float>::fromNormal(axis_).toLocal(direction);
  if (local.z < cosCutoff_ - 1e-5f || !detail::isNear(origin, position, 0)) return false;
  // 1 - cos from the sine where the angle is small.
  const float sine2 = local.x * local.x + local.y * local.y;
  const float height = local.z > 0 ? sine2 / (1 + local.z) : 1 - local.z;
  v = {toUnitInterval(static_cast<double>(height / (1 - cosCutoff_))),
       detail::invertUniformDisk(local.x, local.y).y};
  return true;
}

}  // namespace h2mc
