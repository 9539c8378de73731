// SPDX-License-Identifier: MIT
// The diffuse base under a dielectric coat, as plastic and roughplastic have it: light that the coat
// lets in scatters diffusely, some of it is reflected back inside, and so on.
#pragma once

#include "render/texture/texture.h"

namespace h2mc {

struct LayeredDiffuse {
  TexturePtr reflectance;         // of the base; linear already if `summed`
  float scale = 1;                // of the reflectance, to conserve energy
  float internalReflectance = 0;  // of the coat from inside, for diffuse light
  float inverseEta2 = 1;          // 1 / eta^2: radiance spreads as it leaves the coat
  bool nonlinear = false;         // colour shifts by repeated scattering
  bool summed = false;

  LayeredDiffuse() = default;
  LayeredDiffuse(TexturePtr texture, float s, double internal, double eta, bool shifts)
      : reflectance(std::move(texture)),
        scale(s),
        internalReflectance(float(internal)),
        inverseEta2(float(1 / (eta * eta))),
        nonlinear(shifts) {
    if (const auto* constant = std::get_if<ConstantTexture>(reflectance.get())) {
      const Vec3<double> d = Vec3<double>(constant->color) * double(scale);
      reflectance = constantTexture(Rgbf(d * series(d, internal)));
      scale = 1;
      summed = true;
    }
  }

  // weight * reflectance / (1 - reflectance * internalReflectance); in the linear mode the
  // reflectance in the denominator is 1.
  template <class T>
  Rgb<T> modulated(const Vec2<T>& uv, const T& weight) const {
    using S = Scalar<T>;
    if (summed) return modulate<T>(*reflectance, uv, weight);
    const Rgb<T> d = evaluate<T>(*reflectance, uv) * S(scale);
    return d * series(d, S(internalReflectance)) * weight;
  }
  Rgbf albedo() const {
    const Rgbf d = average(*reflectance) * scale;
    return (summed ? d : d * series(d, internalReflectance)) * (1 - internalReflectance);
  }

 private:
  // 1 / (1 - d r) per channel.
  template <class T>
  Rgb<T> series(const Rgb<T>& d, Scalar<T> r) const {
    using S = Scalar<T>;
    if (!nonlinear) return Rgb<T>(T(S(1) / (S(1) - r)));
    return {S(1) / (S(1) - d.x * r), S(1) / (S(1) - d.y * r), S(1) / (S(1) - d.z * r)};
  }
};

}  // namespace h2mc
