// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"

namespace h2mc {

// Emits the same in all directions from a point.
struct PointLight : LightAtPoint {
  Rgbf intensity{1};  // flux per solid angle

  float power(const SceneBounds&) const { return 4 * kPi * luminance(intensity); }

  template <class T>
  DirectLight<T> sampleDirect(const LightContext&, PrimitiveId, const Vec3<T>& reference, const T&,
                              const T&) const {
    return detail::directFromPoint<T>(position, reference, [&](DirectLight<T>& r, const T& spread) {
      const Vec3<Scalar<T>> color = plain<T>(intensity);
      r.arriving = {spread * color.x, spread * color.y, spread * color.z};
      r.emissionPdf = T(Scalar<T>(kInvPi / 4));
    });
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext&, PrimitiveId, const T&, const T&, const T& v0,
                               const T& v1) const {
    using S = Scalar<T>;
    EmittedRay<T> r;
    r.origin = lift<T>(plain<T>(position));
    r.normal = lift<T>(Vec3<S>(0));
    r.direction = detail::uniformSphere(v0, v1);
    r.flux = detail::passiveColor<T>(intensity * (4 * kPi));
    r.emissionPdf = T(S(kInvPi / 4));
    r.directPdf = r.cosLight = T(S(1));
    return r;
  }

  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& direction,
                      Vec2f& u, Vec2f& v, float& choice) const {
    u = Vec2f(0.5f);
    choice = 0.5f;
    v = detail::invertUniformSphere(direction);
    return detail::isNear(origin, position, 0);
  }
  unsigned wrapsEmission(const LightContext&) const { return 4; }
};

}  // namespace h2mc
