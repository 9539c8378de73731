// SPDX-License-Identifier: MIT
// Lambertian reflection.
#pragma once

#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Diffuse : CosineLobe {
  TexturePtr reflectance;
  float scale = 1;  // of the reflectance, to conserve energy

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const S invPi = kInvPiOf<T>;
    return {modulate<T>(*reflectance, uv, wo.z * (invPi * S(scale))), wo.z * invPi, wi.z * invPi};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    const S invPi = kInvPiOf<T>;
    return {modulate<T>(*reflectance, uv, T(S(scale))), wo.z * invPi, wi.z * invPi};
  }
  Rgbf albedo() const { return average(*reflectance) * scale; }
};

}  // namespace h2mc
