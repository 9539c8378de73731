// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"
#include "render/texture/texture.h"

namespace h2mc {

// Throws a picture from a point, as a pinhole camera would take it: the texture is the irradiance, over pi, of a plane
// across the axis at unit distance, and nothing leaves beside it.
class ProjectorLight : public LightAtPoint {
 public:
  ProjectorLight()
      : ProjectorLight(Vec3f(0), Vec3f(0.5f, 0.5f, 1), Vec3f(-1, 0, 0), Vec3f(0, -1, 0), nullptr,
                       1) {}
  // From the position, at unit distance: where the picture's (0, 0) is, and its edges of u and v, which are across each
  // other and the axis.
  ProjectorLight(const Vec3f& position, const Vec3f& corner, const Vec3f& edgeU, const Vec3f& edgeV,
                 TexturePtr irradiance, float scale);

  float power(const SceneBounds&) const;

  template <class T>
  DirectLight<T> sampleDirect(const LightContext&, PrimitiveId, const Vec3<T>& reference, const T&,
                              const T&) const {
    return detail::directFromPoint<T>(position, reference, [&](DirectLight<T>& r, const T& spread) {
      using S = Scalar<T>;
      const T cosine = -dot(r.direction, plain<T>(axis_));
      r.arriving = lift<T>(Vec3<S>(0));
      r.emissionPdf = T(S(0));
      if (!(value(cosine) > 0)) return;
      const Vec2<T> uv = project<T>(Vec3<T>(-r.direction), cosine);
      if (!isInside(value2(uv))) return;
      const T inverse = S(1) / (cosine * cosine * cosine);
      r.arriving = coloured(uv, T(spread * inverse));
      r.emissionPdf = inverse * S(1 / area_);
    });
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext&, PrimitiveId, const T&, const T&, const T& v0,
                               const T& v1) const {
    using S = Scalar<T>;
    EmittedRay<T> r;
    r.origin = lift<T>(plain<T>(position));
    r.normal = lift<T>(Vec3<S>(0));
    r.direction = normalize(
        ad::combine(v0, plain<T>(edgeU_), v1, plain<T>(edgeV_), T(S(1)), plain<T>(corner_)));
    const T cosine = dot(r.direction, plain<T>(axis_));
    r.flux = coloured(Vec2<T>(v0, v1), T(S(area_)));
    r.emissionPdf = S(1 / area_) / (cosine * cosine * cosine);
    r.directPdf = r.cosLight = T(S(1));
    return r;
  }

  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& direction,
                      Vec2f& u, Vec2f& v, float& choice) const;
  unsigned wrapsEmission(const LightContext&) const { return 0; }

 private:
  // Where on the picture a direction goes that has this cosine, above 0, with the axis.
  template <class T>
  Vec2<T> project(const Vec3<T>& direction, const T& cosine) const {
    using S = Scalar<T>;
    const T inverse = S(1) / cosine;
    return {dot(direction, plain<T>(byU_)) * inverse - S(originU_),
            dot(direction, plain<T>(byV_)) * inverse - S(originV_)};
  }
  template <class S>
  static bool isInside(const Vec2<S>& uv) {
    return uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1;
  }
  template <class T>
  Rgb<T> coloured(const Vec2<T>& uv, const T& factor) const {
    return modulate<T>(*irradiance_, uv, T(factor * Scalar<T>(scale_)));
  }

  Vec3f axis_, corner_, edgeU_, edgeV_;
  Vec3f byU_, byV_;  // edges over the squares of their lengths
  float originU_, originV_;
  float area_;
  float scale_;  // with the factor pi
  TexturePtr irradiance_;
};

}  // namespace h2mc
