// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_sampling.h"

namespace h2mc {

// Emits the same in all directions from a point.
struct PointLight {
  Vec3f position{0};
  Rgbf intensity{1};  // flux per solid angle

  bool isDelta() const { return true; }
  bool isInfinite() const { return false; }
  bool isEnvironment() const { return false; }
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

  template <class T>
  LightHit<T> hit(const LightContext&, const SurfacePoint<T>&, const Vec3<T>&) const {
    return detail::noHit<T>();
  }

  PrimitiveId choosePrimitive(const LightContext&, float) const { return {}; }
  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice) const {
    u = Vec2f(0.5f);
    choice = 0.5f;
    return detail::isNear(reference + direction * distance, position, distance);
  }
  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& direction,
                      Vec2f& u, Vec2f& v, float& choice) const {
    u = Vec2f(0.5f);
    choice = 0.5f;
    v = detail::invertUniformSphere(direction);
    return detail::isNear(origin, position, 0);
  }
  unsigned wrapsDirect(const LightContext&) const { return 0; }
  unsigned wrapsEmission(const LightContext&) const { return 4; }
};

}  // namespace h2mc
