// SPDX-License-Identifier: MIT
// The facets of the principled BSDF's clear coat: D(m) ~ 1 / (alpha^2 cos^2 + sin^2), whose tail is longer than GGX's
// [Burley 2012, "Physically Based Shading at Disney", section B.2, eq. 4 with gamma = 1].
#pragma once

#include <cmath>

#include "render/bsdf/microfacet.h"

namespace h2mc {

// A: a plain number, or the derivative type where the roughness comes from a texture. 0 < alpha < 1.
template <class A>
struct ClearcoatFacets {
  A alpha = A(0.1f);

  // D(h / |h|) cos(m) / (4 wi.m), h = wi + wo, h.z > 0: the density of wo given wi, and the reverse. cos(m) / wi.m
  // is 2 h.z / |h|^2.
  template <class T>
  T pdf(const Vec3<T>& h) const {
    using S = Scalar<T>;
    using ad::dot2;
    const A a2 = alpha * alpha;
    const T spread = dot2(h.x, h.x, h.y, h.y) + ad::square(h.z) * a2;
    return h.z / spread * ((A(S(1)) - a2) / logInverse2() * (S(0.5) * kInvPiOf<T>));
  }
  // The unit normal of a facet, drawn with the density D(m) cos(m); u1 is its azimuth.
  template <class T>
  Vec3<T> sample(const T& u0, const T& u1) const {
    using S = Scalar<T>;
    // sin^2 = (a^2 ^ (1 - u) - a^2) / (1 - a^2).
    const A a2 = alpha * alpha, log = logInverse2(), scale = S(1) / A(S(1) - a2);
    const T u = awayFromPole(u0);
    const T sin2 = ad::expm1(T(u * log)) * A(a2 * scale);
    const T cos2 = ad::expm1(T((u - S(1)) * log)) * A(-scale);
    return fromPolar<T>(ad::sqrt(sin2), ad::sqrt(cos2), u1);
  }
  // The coordinates that draw m (of any length); false if none do.
  bool invert(const Vec3<double>& m, Vec2f& u) const {
    if (!(m.z > 0)) return false;
    const double a2 = double(alpha) * double(alpha);
    const double planar2 = m.x * m.x + m.y * m.y, sin2 = planar2 / (planar2 + m.z * m.z);
    const double u0 = std::log1p(sin2 * (1 - a2) / a2) / -std::log(a2);
    if (!(u0 < 1)) return false;
    u = {toUnitInterval(u0), invertAzimuth(m.x, m.y)};
    return true;
  }

 private:
  // log(1 / alpha^2).
  A logInverse2() const { return ad::log(alpha) * Scalar<A>(-2); }
};

}  // namespace h2mc
