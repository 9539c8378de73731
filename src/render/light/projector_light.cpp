// SPDX-License-Identifier: MIT
#include "render/light/projector_light.h"

#include <algorithm>

namespace h2mc {

ProjectorLight::ProjectorLight(const Vec3f& place, const Vec3f& corner, const Vec3f& edgeU,
                               const Vec3f& edgeV, TexturePtr irradiance, float scale)
    : LightAtPoint{{}, place},
      axis_(glm::normalize(glm::cross(glm::dvec3(edgeU), glm::dvec3(edgeV)))),
      corner_(corner),
      edgeU_(edgeU),
      edgeV_(edgeV),
      byU_(edgeU / dot(edgeU, edgeU)),
      byV_(edgeV / dot(edgeV, edgeV)),
      originU_(dot(corner, byU_)),
      originV_(dot(corner, byV_)),
      area_(glm::length(edgeU) * glm::length(edgeV)),
      scale_(scale * kPi),
      irradiance_(irradiance ? std::move(irradiance) : constantTexture(Rgbf(1))) {
  if (dot(axis_, corner_) < 0) axis_ = -axis_;
}

float ProjectorLight::power(const SceneBounds&) const {
  return scale_ * area_ * luminance(average(*irradiance_));
}

bool ProjectorLight::invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin,
                                    const Vec3f& direction, Vec2f& u, Vec2f& v,
                                    float& choice) const {
  u = Vec2f(0.5f);
  choice = 0.5f;
  const float cosine = dot(direction, axis_);
  if (!(cosine > 0) || !detail::isNear(origin, position, 0)) return false;
  const Vec2f uv = project(direction, cosine);
  constexpr float kRounding = 1e-4f;
  if (std::min(uv.x, uv.y) < -kRounding || std::max(uv.x, uv.y) > 1 + kRounding) return false;
  v = {toUnitInterval(static_cast<double>(uv.x)), toUnitInterval(static_cast<double>(uv.y))};
  return true;
}

}  // namespace h2mc
