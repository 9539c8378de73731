// SPDX-License-Identifier: MIT
// GGX facets with a roughness along each of the frame's axes [Burley 2012, "Physically Based Shading at Disney", B.2],
// with Smith's masking on either side by itself [Heitz 2014, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs", section 5.3]. The same questions as to Facets.
#pragma once

#include "render/bsdf/microfacet.h"

namespace h2mc {

// A: a plain number, or the derivative type where the roughness comes from a texture.
template <class A>
struct AnisotropicFacets {
  static constexpr FacetDistribution distribution = FacetDistribution::kGgx;
  A alphaX = A(0.1f), alphaY = A(0.1f);

  // D(h / |h|) for h of any length, h.z > 0, with h2 = |h|^2.
  template <class T>
  T density(const Vec3<T>& h, const T& h2) const {
    const T ratio =
        h2 / T(ad::square(h.z) + planar2<T>(h, Scalar<T>(1) / alphaX, Scalar<T>(1) / alphaY));
    return ad::square(ratio) * (kInvPiOf<T> / (alphaX * alphaY));
  }

  // G1(w) / cos(w) of a unit direction, w.z >= 0; finite at 0.
  template <class T>
  T maskingOverCos(const Vec3<T>& w) const {
    return Scalar<T>(2) / T(w.z + ad::sqrt(T(ad::square(w.z) + planar2<T>(w, alphaX, alphaY))));
  }
  // G1(w): as Facets::masking() keeps what varies little apart from the cosine.
  template <class T>
  T masking(const Vec3<T>& w) const {
    using S = Scalar<T>;
    const T planar = planar2<T>(w, alphaX, alphaY), c2 = ad::square(w.z);
    if (value(planar) < value(c2)) return S(2) / T(ad::sqrt(T(planar / c2 + S(1))) + S(1));
    return w.z * S(2) / T(w.z + ad::sqrt(T(c2 + planar)));
  }

  template <class T>
  FacetReflection<T> reflect(const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    const Vec3<T> h = wi + wo;
    const T h2 = ad::length2(h);
    if (!(value(h2) > S(Microfacet::kSmallestHalf2))) return FacetReflection<T>::none();
    const T quarterD = density(h, h2) * S(0.25);
    return {ad::sqrt(T(h2 * S(0.25))), masking(wo), quarterD * maskingOverCos(wi),
            quarterD * maskingOverCos(wo)};
  }

  // The unit normal of a facet that wi sees.
  template <class T>
  Vec3<T> sample(const Vec3<T>& wi, const T& u0, const T& u1) const {
    return sampleVisibleGgx(wi, alphaX, alphaY, u0, u1);
  }
  bool invert(const Vec3<double>& wi, const Vec3<double>& m, Vec2f& u) const {
    return invertVisibleGgx(wi, m, double(alphaX), double(alphaY), u);
  }

 private:
  // (x a)^2 + (y b)^2.
  template <class T, class B>
  static T planar2(const Vec3<T>& w, const B& a, const B& b) {
    using ad::dot2;
    const T x = w.x * a, y = w.y * b;
    return dot2(x, x, y, y);
  }
};

}  // namespace h2mc
