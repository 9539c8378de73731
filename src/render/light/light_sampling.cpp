// SPDX-License-Identifier: MIT
#include "render/light/light_sampling.h"

#include <algorithm>
#include <cmath>

namespace h2mc::detail {

Vec2f invertUniformDisk(float x, float y) {
  return {toUnitInterval(static_cast<double>(x) * x + static_cast<double>(y) * y),
          toUnitInterval(turns(static_cast<double>(y), static_cast<double>(x)))};
}

Vec2f invertUniformSphere(const Vec3f& direction) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(direction));
  return {toUnitInterval(turns(d.y, d.x)), toUnitInterval((1 - d.z) / 2)};
}

bool invertDiskTowards(const SceneBounds& bounds, const Vec3f& toLight, const Vec3f& point,
                       Vec2f& u) {
  const Frame<float> frame = Frame<float>::fromNormal(toLight);
  const Vec3f p = (point - bounds.center) / bounds.radius;
  const float x = dot(p, frame.s), y = dot(p, frame.t);
  if (!(x * x + y * y <= 1.001f)) return false;
  u = invertUniformDisk(x, y);
  return true;
}

}  // namespace h2mc::detail
