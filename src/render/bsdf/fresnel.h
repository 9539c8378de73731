// SPDX-License-Identifier: MIT
// Fresnel reflectance of smooth interfaces, for unpolarised light.
#pragma once

#include "render/bsdf/unary.h"
#include "render/core/types.h"

namespace h2mc {

// Share of light reflected where it meets a medium of relative index `eta` (the far side's over the
// near side's) at cosine c >= 0. With q = eta cos(theta_t): r_s = (c - q) / (c + q),
// r_p = (eta^2 c - q) / (eta^2 c + q). For indices near 1 both differences cancel; since
// q^2 - c^2 = eta^2 - 1 they are multiples of that, and eta - 1 is exact. Differentiable except at the
// critical angle.
template <class T>
T fresnelDielectric(const T& c, Scalar<T> eta) {
  using S = Scalar<T>;
  if (eta == S(1)) return T(0);
  return ofOne(c, [eta](const auto& c1) {
    using U = std::remove_cvref_t<decltype(c1)>;
    const S eta2 = eta * eta, difference = (eta - S(1)) * (eta + S(1));
    const U c2 = c1 * c1;
    const U q2 = c2 + difference;
    if (!(value(q2) > 0)) return U(S(1));
    const U q = ad::sqrt(q2);
    const U sumS = c1 + q, sumP = c1 * eta2 + q;
    const U s = S(-difference) / (sumS * sumS);
    const U p = (c2 * (eta2 + S(1)) - S(1)) * difference / (sumP * sumP);
    return U((s * s + p * p) * S(0.5));
  });
}

// 1 - fresnelDielectric, without its cancellation.
template <class T>
T transmitDielectric(const T& c, Scalar<T> eta) {
  using S = Scalar<T>;
  if (eta == S(1)) return T(1);
  return ofOne(c, [eta](const auto& c1) {
    using U = std::remove_cvref_t<decltype(c1)>;
    const S eta2 = eta * eta;
    const U q2 = c1 * c1 + (eta - S(1)) * (eta + S(1));
    if (!(value(q2) > 0)) return U(S(0));
    const U q = ad::sqrt(q2);
    const U s = c1 + q, t = c1 * eta2 + q;
    return U(c1 * q * S(2) * (S(1) / (s * s) + eta2 / (t * t)));
  });
}

// The same from both cosines, which Snell's law must connect: no root, so no singularity.
template <class T>
T transmitDielectric(const T& cosNear, const T& cosFar, Scalar<T> eta) {
  using S = Scalar<T>;
  const T q = cosFar * eta;
  const T s = cosNear + q, t = cosNear * eta + cosFar;
  const T product = cosNear * q;
  return product * S(2) * (S(1) / (s * s) + S(1) / (t * t));
}

// Reflectance of a conductor with complex relative index eta + i k, exactly. With (a + i b)^2 =
// (eta + i k)^2 - sin^2: r_s as usual in a, b; r_p = r_s times a factor [Moeller 1988, "Optics"].
template <class T>
T fresnelConductor(const T& c, Scalar<T> eta, Scalar<T> k) {
  using S = Scalar<T>;
  return ofOne(c, [eta, k](const auto& c1) {
    using U = std::remove_cvref_t<decltype(c1)>;
    const U cos2 = c1 * c1;
    const U sin2 = S(1) - cos2;
    const S product = eta * k;
    const U d = (eta - k) * (eta + k) - sin2;                     // a^2 - b^2
    const U sum = ad::sqrt(U(d * d + S(4) * product * product));  // a^2 + b^2
    if (!(value(sum) > 0)) return U(S(1));
    const U a = value(d) > 0 ? U(ad::sqrt(U((sum + d) * S(0.5))))  // a b = eta k
                             : U(product / ad::sqrt(U((sum - d) * S(0.5))));
    const U u = sum + cos2, v = a * c1 * S(2);
    const U s = (u - v) / (u + v);
    const U x = sum * cos2 + sin2 * sin2, y = v * sin2;
    return U(s * (S(1) + (x - y) / (x + y)) * S(0.5));
  });
}

// Fresnel reflectance of diffuse light: 2 int_0^1 F(c) c dc.
double fresnelDiffuse(double eta);

}  // namespace h2mc
