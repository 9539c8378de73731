// SPDX-License-Identifier: MIT
// Rough diffuse surfaces [Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model"].
#pragma once

#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/core/safe_math.h"
#include "render/texture/texture.h"

namespace h2mc {

// Grooves of Lambertian facets whose slopes' angle has the standard deviation sigma, in radians; 0 is
// Lambert's. Directions are drawn as from a diffuse surface.
struct RoughDiffuse : CosineLobe {
  TexturePtr reflectance;
  float scale = 1;  // of the reflectance, to conserve energy
  float sigma = 0.14f;
  bool fast = false;  // the paper's approximation (eq. 30) instead of its full model (eqs. 27-29)

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const T pdf = wo.z * kInvPiOf<T>;
    return {weight(uv, wi, wo) * pdf, pdf, wi.z * kInvPiOf<T>};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    return {weight(uv, wi, wo), wo.z * kInvPiOf<T>, wi.z * kInvPiOf<T>};
  }
  Rgbf albedo() const { return average(*reflectance) * scale; }

 private:
  // The BRDF times pi.
  template <class T>
  Rgb<T> weight(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    using ad::dot2;
    const S s2 = S(sigma) * S(sigma);
    // What the paper calls cos(phi_r - phi_i) sin(alpha) tan(beta), alpha the larger of the angles to the
    // normal: smooth at the normal, where its factors are not.
    const T across = dot2(wi.x, wo.x, wi.y, wo.y);
    const bool steeper = value(wi.z) > value(wo.z);
    const T& cosBeta = steeper ? wi.z : wo.z;
    const S c1 = S(1) - S(0.5) * s2 / (s2 + S(0.33)), facing = S(0.45) * s2 / (s2 + S(0.09));
    const bool sameSide = value(across) > 0;
    if (fast) {
      if (!sameSide) return modulate<T>(*reflectance, uv, T(S(scale) * c1));
      return modulate<T>(*reflectance, uv, T((across / cosBeta * facing + c1) * S(scale)));
    }
    const T sinI = safeSqrt(T(dot2(wi.x, wi.x, wi.y, wi.y)));
    const T sinO = safeSqrt(T(dot2(wo.x, wo.x, wo.y, wo.y)));
    const T angleI = ad::atan2(sinI, wi.z), angleO = ad::atan2(sinO, wo.z);
    const T& beta = steeper ? angleI : angleO;
    const T& sinAlpha = steeper ? sinO : sinI;
    const T sines = sinI * sinO;
    const bool hasAzimuth = value(sines) > S(1e-12);
    const T cosPhi = hasAzimuth ? T(across / sines) : T(S(0));
    const T turned = beta * (S(2) * kInvPiOf<T>);
    T single(c1), grooves = across / cosBeta * facing;
    if (!sameSide && value(sinAlpha) > 0)
      grooves = grooves * (S(1) - turned * turned * turned / sinAlpha);
    single = single + grooves;
    const T product = angleI * angleO * (S(4) * kInvPiOf<T> * kInvPiOf<T>);
    const T tanHalf = (sinI + sinO) / (wi.z + wo.z);
    single = single + (S(1) - ad::abs(cosPhi)) * product * product * tanHalf *
                          (S(0.125) * s2 / (s2 + S(0.09)));
    const T twice = (S(1) - cosPhi * turned * turned) * (S(0.17) * s2 / (s2 + S(0.13)));
    const Rgb<T> rho = modulate<T>(*reflectance, uv, T(S(scale)));
    // The fit is below zero for very rough surfaces, where light grazes and comes back on the other side.
    const auto reflected = [&](const T& r) {
      const T sum = single + r * twice;
      return value(sum) > 0 ? T(r * sum) : T(S(0));
    };
    return {reflected(rho.x), reflected(rho.y), reflected(rho.z)};
  }
};

}  // namespace h2mc
