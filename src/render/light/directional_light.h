// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"

namespace h2mc {

// Light from infinitely far that travels along one direction.
struct DirectionalLight : DeltaLight {
  Vec3f direction{0, 0, 1};  // unit: the way the light goes
  Rgbf irradiance{1};        // on a surface across the direction

  bool isInfinite() const { return true; }
  float power(const SceneBounds& bounds) const {
    return luminance(irradiance) / detail::diskPdf<float>(bounds);
  }

  template <class T>
  DirectLight<T> sampleDirect(const LightContext& context, PrimitiveId, const Vec3<T>&, const T&,
                              const T&) const {
    using S = Scalar<T>;
    DirectLight<T> r;
    r.direction = lift<T>(-plain<T>(direction));
    r.distance = T(S(detail::beyond(context.bounds)));
    r.arriving = detail::passiveColor<T>(irradiance);
    r.directPdf = r.cosLight = T(S(1));
    r.emissionPdf = T(detail::diskPdf<S>(context.bounds));
    return r;
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId, const T& u0, const T& u1,
                               const T&, const T&) const {
    using S = Scalar<T>;
    EmittedRay<T> r;
    r.origin = detail::passiveDiskTowards<T>(context.bounds, -plain<T>(direction), u0, u1);
    r.direction = lift<T>(plain<T>(direction));
    r.normal = lift<T>(Vec3<S>(0));
    r.flux = detail::passiveColor<T>(irradiance / detail::diskPdf<float>(context.bounds));
    r.emissionPdf = T(detail::diskPdf<S>(context.bounds));
    r.directPdf = r.cosLight = T(S(1));
    return r;
  }

  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f&, const Vec3f& toLight, float,
                    Vec2f& u, float& choice) const {
    u = Vec2f(0.5f);
    choice = 0.5f;
    return dot(toLight, direction) < -1 + 1e-5f;
  }
  bool invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                      const Vec3f& along, Vec2f& u, Vec2f& v, float& choice) const {
    v = Vec2f(0.5f);
    choice = 0.5f;
    return dot(along, direction) > 1 - 1e-5f &&
           detail::invertDiskTowards(context.bounds, -direction, origin, u);
  }
  unsigned wrapsEmission(const LightContext&) const { return 2; }
};

}  // namespace h2mc
