// SPDX-License-Identifier: MIT
// A thin pane of a smooth dielectric: what goes through goes straight on.
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

// With the reflectance r of one of its two interfaces, the pane's with all reflections inside it is
// 2 r / (1 + r), their geometric series; the rest is transmitted. The same from both sides.
struct ThinDielectric : DeltaLobes {
  static constexpr int kLobes = 2;
  static constexpr int kReflect = 0, kTransmit = 1;
  float eta = 1.5f;  // index of the pane over that around it
  TexturePtr specularReflectance, specularTransmittance;
  float reflectanceScale = 1, transmittanceScale = 1;  // to conserve energy

  bool transmits() const { return true; }

  float lobeSplit(const Vec2f&, const Vec3f& wi, float, float) const { return reflectance(wi.z); }
  int chooseLobe(const Vec2f&, const Vec3f& wi, float, float, float choice) const {
    return choice < reflectance(wi.z) ? kReflect : kTransmit;
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int lobe) const {
    using S = Scalar<T>;
    const S r = reflectance(value(wi.z));
    const S probability = lobe == kReflect ? r : S(1) - r;
    if (!(probability > 0)) return DeltaSample<T>::none();
    const Rgb<T> share = lobe == kReflect
                             ? modulate<T>(*specularReflectance, uv, T(S(reflectanceScale)))
                             : modulate<T>(*specularTransmittance, uv, T(S(transmittanceScale)));
    return {lobe == kReflect ? mirrored(wi) : -wi, share, share, probability};
  }
  Rgbf albedo() const { return average(*specularTransmittance) * transmittanceScale; }

 private:
  template <class S>
  S reflectance(S cosine) const {
    const S r = fresnelDielectric(std::abs(cosine), S(eta));
    return S(2) * r / (S(1) + r);
  }
};

}  // namespace h2mc
