// SPDX-License-Identifier: MIT
// The complex refractive index of a metal, per colour channel.
#pragma once

#include "render/bsdf/fresnel.h"

namespace h2mc {

struct ConductorIndex {
  Rgbf eta{0}, k{1};   // relative to the medium outside
  bool mirror = true;  // eta = 0: reflects everything

  // reflectance * F(c), c = cosine of incidence.
  template <class T>
  Rgb<T> reflect(const Rgb<T>& reflectance, const T& c) const {
    using S = Scalar<T>;
    if (mirror) return reflectance;
    return {reflectance.x * fresnelConductor<T>(c, S(eta.x), S(k.x)),
            reflectance.y * fresnelConductor<T>(c, S(eta.y), S(k.y)),
            reflectance.z * fresnelConductor<T>(c, S(eta.z), S(k.z))};
  }
};

}  // namespace h2mc
