// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"
#include "render/texture/texture.h"

namespace h2mc {

// Emits from a point into a cone: constant within the beam, then falling linearly with the angle to
// zero at the cutoff. A texture colours it, projected on a plane across the axis.
class SpotLight : public LightAtPoint {
 public:
  SpotLight() : SpotLight(Vec3f(0), Vec3f(0, 0, 1), Rgbf(1), 20, 15) {}
  // axis: unit; angles from the axis in degrees. Precondition: 0 < cutoff <= 180, 0 <= beam <= cutoff.
  SpotLight(const Vec3f& position, const Vec3f& axis, const Rgbf& intensity, float cutoff,
            float beam);

  // Lights through a texture from here on: (0.5, 0.5) on the axis, 1 further where the cutoff meets the plane
  // in direction `x`, which with y is across the axis; unit all. Precondition: cutoff below 90 degrees.
  void project(TexturePtr texture, const Vec3f& x, const Vec3f& y);

  float power(const SceneBounds&) const;

  template <class T>
  DirectLight<T> sampleDirect(const LightContext&, PrimitiveId, const Vec3<T>& reference, const T&,
                              const T&) const {
    return detail::directFromPoint<T>(position, reference, [&](DirectLight<T>& r, const T& spread) {
      using S = Scalar<T>;
      const T fade = falloff<T>(Vec3<T>(-r.direction)) * spread;
      r.arriving = coloured<T>(Vec3<T>(-r.direction), fade);
      r.emissionPdf =
          T(dot(value3(r.direction), plain<T>(axis_)) < -S(cosCutoff_) ? S(conePdf_) : S(0));
    });
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext&, PrimitiveId, const T&, const T&, const T& v0,
                               const T& v1) const {
    using S = Scalar<T>;
    // Uniform in the cone, v1 the azimuth.
    const T height = v0 * S(1 - cosCutoff_);  // 1 - cos
    const T sine = safeSqrt(T(height * (S(2) - height)));
    const Vec2<T> c = detail::circle(v1);
    const Frame<S> frame = Frame<S>::fromNormal(plain<T>(axis_));
    EmittedRay<T> r;
    r.origin = lift<T>(plain<T>(position));
    r.normal = lift<T>(Vec3<S>(0));
    r.direction =
        ad::combine(T(sine * c.x), frame.s, T(sine * c.y), frame.t, T(S(1) - height), frame.n);
    const T fade = falloff<T>(r.direction) * S(1 / conePdf_);
    r.flux = coloured<T>(r.direction, fade);
    r.emissionPdf = T(S(conePdf_));
    r.directPdf = r.cosLight = T(S(1));
    return r;
  }

  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& direction,
                      Vec2f& u, Vec2f& v, float& choice) const;
  unsigned wrapsEmission(const LightContext&) const { return 8; }

 private:
  // The share of the intensity that leaves along unit `direction`.
  template <class T>
  T falloff(const Vec3<T>& direction) const {
    using S = Scalar<T>;
    const T cosine = dot(direction, plain<T>(axis_));
    if (value(cosine) <= S(cosCutoff_)) return T(S(0));
    if (value(cosine) >= S(cosBeam_)) return T(S(1));
    const Vec3<T> across = direction - plain<T>(axis_) * cosine;
    const T angle = ad::atan2(safeSqrt(ad::length2(across)), cosine);
    return (S(cutoff_) - angle) * S(1 / (cutoff_ - beam_));
  }

  // The intensity in unit `direction`, within the cone, times `factor`.
  template <class T>
  Rgb<T> coloured(const Vec3<T>& direction, const T& factor) const {
    const Vec3<Scalar<T>> color = plain<T>(intensity_);
    const Rgb<T> result{factor * color.x, factor * color.y, factor * color.z};
    if (!texture_) [[likely]]
      return result;
    return projected(direction, result);
  }
  template <class T>
  [[gnu::noinline]] Rgb<T> projected(const Vec3<T>& direction, const Rgb<T>& factor) const {
    using S = Scalar<T>;
    const T z = dot(direction, plain<T>(axis_));
    if (!(value(z) > 0)) return Rgb<T>(T(S(0)));
    const T scale = T(S(0.5) / S(tanCutoff_)) / z;
    const Vec2<T> uv{dot(direction, plain<T>(x_)) * scale + S(0.5),
                     dot(direction, plain<T>(y_)) * scale + S(0.5)};
    return factor * evaluate<T>(*texture_, uv);
  }

  Vec3f axis_;
  Rgbf intensity_;
  float cutoff_, beam_;  // radians
  float cosCutoff_, cosBeam_, conePdf_;
  TexturePtr texture_;  // may be null
  Vec3f x_{0}, y_{0};
  float tanCutoff_ = 0;
};

}  // namespace h2mc
