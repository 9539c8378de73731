// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"

namespace h2mc {

// The same radiance from every direction.
struct ConstantLight : LightWithoutArea {
  Rgbf radiance{1};

  bool isDelta() const { return false; }
  bool isInfinite() const { return true; }
  bool isEnvironment() const { return true; }
  float power(const SceneBounds& bounds) const {
    return 4 * kPi * luminance(radiance) / detail::diskPdf<float>(bounds);
  }

  template <class T>
  DirectLight<T> sampleDirect(const LightContext& context, PrimitiveId, const Vec3<T>&, const T& u0,
                              const T& u1) const {
    return detail::directFromInfinity<T>(context.bounds, detail::uniformSphere(u0, u1),
                                         T(Scalar<T>(kInvPi / 4)), arriving<T>());
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId, const T& u0, const T& u1,
                               const T& v0, const T& v1) const {
    return detail::emittedFromInfinity<T>(context.bounds, detail::uniformSphere(v0, v1),
                                          T(Scalar<T>(kInvPi / 4)), arriving<T>(), u0, u1);
  }

  template <class T>
  LightHit<T> hit(const LightContext& context, const SurfacePoint<T>&, const Vec3<T>&) const {
    using S = Scalar<T>;
    return {detail::passiveColor<T>(radiance), T(S(kInvPi / 4)),
            T(S(kInvPi / 4) * detail::diskPdf<S>(context.bounds))};
  }

  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f&, const Vec3f& direction, float,
                    Vec2f& u, float& choice) const {
    u = detail::invertUniformSphere(direction);
    choice = 0.5f;
    return true;
  }
  bool invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                      const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const {
    v = detail::invertUniformSphere(-direction);
    choice = 0.5f;
    return detail::invertDiskTowards(context.bounds, -direction, origin, u);
  }
  unsigned wrapsDirect(const LightContext&) const { return 1; }
  unsigned wrapsEmission(const LightContext&) const { return 2 | 4; }

 private:
  template <class T>
  Rgb<T> arriving() const {
    return detail::passiveColor<T>(radiance * (4 * kPi));
  }
};

}  // namespace h2mc
