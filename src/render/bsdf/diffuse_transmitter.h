// SPDX-License-Identifier: MIT
// Lambertian transmission: light leaves on the other side, whichever it came from.
#pragma once

#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct DiffuseTransmitter : NonDeltaLobes {
  static constexpr int kLobes = 1;
  TexturePtr transmittance;
  float scale = 1;  // of the transmittance, to conserve energy

  bool transmits() const { return true; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!crosses(wi, wo)) return BsdfValue<T>::zero();
    const T pdf = ad::abs(wo.z) * kInvPiOf<T>;
    return {modulate<T>(*transmittance, uv, pdf * S(scale)), pdf, ad::abs(wi.z) * kInvPiOf<T>};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!crosses(wi, wo)) return SampledBsdf<T>::zero();
    return {modulate<T>(*transmittance, uv, T(S(scale))), ad::abs(wo.z) * kInvPiOf<T>,
            ad::abs(wi.z) * kInvPiOf<T>};
  }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>& wi, int, const T& u0, const T& u1) const {
    const Vec3<T> wo = sampleCosine(u0, u1);
    return value(wi.z) > 0 ? flipped(wo) : wo;
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int) const {
    return crosses(wi, wo) ? T(ad::abs(wo.z) * kInvPiOf<T>) : T(0);
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int, Vec2f& u) const {
    return crosses(wi, wo) && invertCosine(wo.z < 0 ? flipped(wo) : wo, u);
  }
  float width(int) const { return kPi / 2; }
  Rgbf albedo() const { return average(*transmittance) * scale; }

 private:
  template <class T>
  static bool crosses(const Vec3<T>& wi, const Vec3<T>& wo) {
    return value(wi.z) != 0 && value(wo.z) != 0 && (value(wi.z) > 0) != (value(wo.z) > 0);
  }
};

}  // namespace h2mc
