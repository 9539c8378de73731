#pragma once

#include "render/light/light_sampling.h"

namespace h2mc {

// Emits from a point into a cone: constant within the beam, then falling linearly with the angle to
// zero at the cutoff.
class SpotLight {
 public:
  SpotLight() : SpotLight(Vec3f(0), Vec3f(0, 0, 1), Rgbf(1), 20, 15) {}
  // axis: unit; angles from the axis in degrees. Precondition: 0 < cutoff <= 180, 0 <= beam <= cutoff.
  SpotLight(const Vec3f& position, const Vec3f& axis, const Rgbf& intensity, float cutoff,
            float beam);

  bool isDelta() const { return true; }
  bool isInfinite() const { return false; }
  bool isEnvironment() const { return false; }
  float power(const SceneBounds&) const;

  template <class T>
  DirectLight<T> sampleDirect(const LightContext&, PrimitiveId, const Vec3<T>& reference, const T&,
                              const T&) const {
    return detail::directFromPoint<T>(
        position_, reference, [&](DirectLight<T>& r, const T& spread) {
          using S = Scalar<T>;
          const T fade = falloff<T>(Vec3<T>(-r.direction)) * spread;
          const Vec3<S> color = plain<T>(intensity_);
          r.arriving = {fade * color.x, fade * color.y, fade * color.z};
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
    r.origin = lift<T>(plain<T>(position_));
    r.normal = lift<T>(Vec3<S>(0));
    r.direction =
        ad::combine(T(sine * c.x), frame.s, T(sine * c.y), frame.t, T(S(1) - height), frame.n);
    const T fade = falloff<T>(r.direction) * S(1 / conePdf_);
    const Vec3<S> color = plain<T>(intensity_);
    r.flux = {fade * color.x, fade * color.y, fade * color.z};
    r.emissionPdf = T(S(conePdf_));
    r.directPdf = r.cosLight = T(S(1));
    return r;
  }

  template <class T>
  LightHit<T> hit(const LightContext&, const SurfacePoint<T>&, const Vec3<T>&) const {
    return detail::noHit<T>();
  }

  PrimitiveId choosePrimitive(const LightContext&, float) const { return {}; }
  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice) const;
  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& direction,
                      Vec2f& u, Vec2f& v, float& choice) const;
  unsigned wrapsDirect(const LightContext&) const { return 0; }
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

  Vec3f position_, axis_;
  Rgbf intensity_;
  float cutoff_, beam_;  // radians
  float cosCutoff_, cosBeam_, conePdf_;
};

}  // namespace h2mc
