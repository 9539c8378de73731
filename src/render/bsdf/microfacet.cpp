// SPDX-License-Identifier: MIT
#include "render/bsdf/microfacet.h"

#include <cmath>

namespace h2mc {

bool invertVisibleGgx(const Vec3<double>& wi, const Vec3<double>& m, double ax, double ay,
                      Vec2f& u) {
  if (!(m.z > 0)) return false;
  const Vec3<double> w = glm::normalize(Vec3<double>(ax * wi.x, ay * wi.y, wi.z));
  const Vec3<double> i = glm::normalize(Vec3<double>(m.x / ax, m.y / ay, m.z));
  const double d = dot(w, i);
  if (!(d > 0)) return false;
  const Vec3<double> c = 2 * d * i - w;
  const double down = c.z > 0 ? (c.x * c.x + c.y * c.y) / (1 + c.z) : 1 - c.z;
  u = {toUnitInterval(down / (1 + w.z)), invertAzimuth(c.x, c.y)};
  return true;
}

template <>
bool Microfacet::invert(const Vec3<double>& wi, const Vec3<double>& m, Vec2f& u) const {
  if (!(m.z > 0)) return false;
  const double a = alpha;
  if (distribution == FacetDistribution::kPhong) {
    const double tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
    const double e = std::max(2 / (a * a) - 2, 0.0);
    const double u0 = -std::expm1(-0.5 * (e + 2) * std::log1p(tan2));  // cos^2 = 1 / (1 + tan^2)
    if (!(u0 < 1)) return false;
    u = {toUnitInterval(u0), invertAzimuth(m.x, m.y)};
    return true;
  }
  if (distribution == FacetDistribution::kBeckmann) {
    const double tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
    const double u0 = -std::expm1(-tan2 / (a * a));
    if (!(u0 < 1)) return false;
    u = {toUnitInterval(u0), invertAzimuth(m.x, m.y)};
    return true;
  }
  return invertVisibleGgx(wi, m, a, a, u);
}

}  // namespace h2mc
