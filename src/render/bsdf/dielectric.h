// SPDX-License-Identifier: MIT
// A smooth interface between two dielectrics: glass, water.
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Dielectric : DeltaLobes {
  static constexpr int kLobes = 2;
  static constexpr int kReflect = 0, kTransmit = 1;
  float eta = 1.5f;  // index of the inside (z < 0) over the outside's
  TexturePtr specularReflectance, specularTransmittance;
  float reflectanceScale = 1, transmittanceScale = 1;  // to conserve energy

  bool transmits() const { return true; }

  float lobeSplit(const Vec2f&, const Vec3f& wi, float, float) const {
    const float near = wi.z < 0 ? 1 / eta : eta;
    return fresnelDielectric(std::abs(wi.z), near);
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    return choice < lobeSplit(uv, wi, u0, u1) ? kReflect : kTransmit;
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int lobe) const {
    using S = Scalar<T>;
    const bool inside = value(wi.z) < 0;
    const S relative = inside ? S(1) / S(eta) : S(eta);
    const T c = inside ? T(-wi.z) : wi.z;
    if (lobe == kReflect) {
      const S f = fresnelDielectric(value(c), relative);
      if (!(f > 0)) return DeltaSample<T>::none();
      const Rgb<T> r = modulate<T>(*specularReflectance, uv, T(S(reflectanceScale)));
      return {mirrored(wi), r, r, f};
    }
    const S inverse = S(1) / relative;
    const T cosFar2 = (c * c - S(1)) * (inverse * inverse) + S(1);
    const S t = transmitDielectric(value(c), relative);
    if (!(value(cosFar2) > 0 && t > 0)) return DeltaSample<T>::none();
    const T cosFar = ad::sqrt(cosFar2);
    const Rgb<T> r = modulate<T>(*specularTransmittance, uv, T(S(transmittanceScale)));
    return {{wi.x * -inverse, wi.y * -inverse, inside ? cosFar : T(-cosFar)},
            r * (inverse * inverse),
            r,
            t};
  }
  Rgbf albedo() const { return average(*specularTransmittance) * transmittanceScale; }
};

}  // namespace h2mc
