// SPDX-License-Identifier: MIT
// Isotropic microfacet surfaces [Walter et al. 2007, "Microfacet Models for Refraction through Rough
// Surfaces"]: the distribution of facet normals, masking, and the sampling of facets.
//
// Facets are drawn by coordinates that are smooth in everything and whose second one is an azimuth:
//
//  - GGX: visible normals by spherical caps [Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
//    with Spherical Caps"]. The weight is F G1(wo) <= 1, and at normal incidence the map is the
//    classic one.
//  - Beckmann: all normals by D(m) cos(m) [Walter et al., eqs. 28-29]. The exact map of its visible
//    normals is a root-finding with no azimuth to wrap; this one has a closed inverse. Weights
//    exceed 1 only at grazing incidence, where masking holds them near 1 / alpha at worst.
//  - Phong: all normals by D(m) cos(m) as well [Walter et al., eqs. 31-32], with the exponent
//    2 / alpha^2 - 2 and Beckmann's masking, as Mitsuba 0.6 has them.
//
// Directions here have z > 0; a facet's normal m too.
#pragma once

#include "render/bsdf/unary.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

enum class FacetDistribution : std::uint8_t { kBeckmann, kGgx, kPhong };

// Reflection by facets, without the Fresnel term.
template <class T>
struct FacetReflection {
  T cosHalf;          // wi.m = wo.m, 0 if nothing is reflected
  T weight;           // D G / (4 |cos(wi)|), the BRDF times |cos(wo)|, over pdf
  T pdf, pdfReverse;  // of wo given wi, of wi given wo
  static FacetReflection none() { return {T(0), T(0), T(0), T(0)}; }
};

// The normal of a GGX facet with roughnesses ax along x and ay along y, drawn among those that wi sees: wi on the
// stretched hemisphere, a point of the cap around z that it sees, and the normal halfway between. Unit.
template <class T, class A>
Vec3<T> sampleVisibleGgx(const Vec3<T>& wi, const A& ax, const A& ay, const T& u0, const T& u1) {
  using S = Scalar<T>;
  const T u = awayFromPole(u0);
  const Vec3<T> stretched(wi.x * ax, wi.y * ay, wi.z);
  const T inverse = ad::rsqrt(ad::length2(stretched));
  const T cosine = stretched.z * inverse;
  const T one = cosine + S(1);
  const T down = one * u, up = one * (S(1) - u);  // 1 - c.z of the cap's point c, c.z + cos(wi)
  const T sine = ad::sqrt(T(down * ad::max(T(S(1) - cosine + up), S(kSmallestCoordinate))));
  const Vec3<T> c = fromPolar<T>(sine, up, u1);
  const Vec3<T> h((c.x + stretched.x * inverse) * ax, (c.y + stretched.y * inverse) * ay, c.z);
  return ad::normalize(h);
}
// The coordinates that draw m (of any length, m.z > 0); false if none do.
bool invertVisibleGgx(const Vec3<double>& wi, const Vec3<double>& m, double ax, double ay,
                      Vec2f& u);

// A: float, or the derivative type where the roughness comes from a texture.
template <class A>
struct Facets {
  FacetDistribution distribution = FacetDistribution::kBeckmann;
  A alpha = A(0.1f);

  // D(h / |h|) for h of any length, h.z > 0, with h2 = |h|^2.
  template <class T>
  T density(const Vec3<T>& h, const T& h2) const {
    using S = Scalar<T>;
    const auto a = roughness<T>();
    const auto a2 = square(a);
    using ad::dot2;
    const T planar = dot2(h.x, h.x, h.y, h.y), vertical = ad::square(h.z);
    if (distribution == FacetDistribution::kGgx) {
      const T ratio = h2 / (vertical + planar * (S(1) / a2));
      return ad::square(ratio) * (kInvPiOf<T> / a2);
    }
    if (distribution == FacetDistribution::kPhong) {
      const auto e = exponent<T>();
      const T power = ad::log1p(T(planar * (S(-1) / h2))) * (e * S(0.5));
      if (!(value(power) > S(-80))) return T(0);
      return ad::exp(power) * ((e + S(2)) * (S(0.5) * kInvPiOf<T>));
    }
    const T exponent = planar / vertical * (S(-1) / a2);
    if (!(value(exponent) > S(-80))) return T(0);
    const T ratio = h2 / vertical;
    return ad::exp(exponent) * ad::square(ratio) * (kInvPiOf<T> / a2);
  }

  // G1(w) / cos(w) as a function of c = cos(w) >= 0; finite at c = 0. The facet must not be seen
  // from behind.
  template <class T>
  T maskingOverCos(const T& cosine) const {
    using S = Scalar<T>;
    const bool ggx = distribution == FacetDistribution::kGgx;
    return ofCosine(cosine, [ggx](const auto& c, const auto& a) {
      using U = std::remove_cvref_t<decltype(c)>;
      // 2 / (1 + sqrt(1 + alpha^2 tan^2)) [Walter et al., eq. 34]
      if (ggx) return U(S(2) / (c + ad::sqrt(U(c * c * (S(1) - a * a) + a * a))));
      // Their rational approximation [eq. 27], in x = 1 / (alpha tan).
      if (!isMasked(value(c), value(a))) return U(S(1) / c);
      const U s = S(1) / (ad::sqrt(U(S(1) - c * c)) * a);
      const U x = c * s;
      return U(s * (S(3.535) + S(2.181) * x) / (S(1) + x * (S(2.276) + S(2.577) * x)));
    });
  }

  // G1(w). Where masking is weak it varies little with c, however fast c itself does: the product of
  // maskingOverCos(c) and c would have to cancel that.
  template <class T>
  T masking(const T& cosine) const {
    using S = Scalar<T>;
    const S c = value(cosine), a = value(roughness<T>()), a2 = a * a;
    if (distribution != FacetDistribution::kGgx) {
      if (!isMasked(c, a)) return T(S(1));
    } else if (a2 * (S(1) - c * c) < c * c) {
      return ofCosine(cosine, [](const auto& x, const auto& alpha) {
        using U = std::remove_cvref_t<decltype(x)>;
        const U tan2 = S(1) / (x * x) - S(1);
        return U(S(2) / (S(1) + ad::sqrt(U(S(1) + tan2 * (alpha * alpha)))));
      });
    }
    return maskingOverCos(cosine) * cosine;
  }

  // The same of unit directions w.
  template <class T>
  T maskingOverCos(const Vec3<T>& w) const {
    return maskingOverCos(w.z);
  }
  template <class T>
  T masking(const Vec3<T>& w) const {
    return masking(w.z);
  }

  template <class T>
  FacetReflection<T> reflect(const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    const Vec3<T> h = wi + wo;
    const T h2 = ad::length2(h);
    if (!(value(h2) > kSmallestHalf2)) return FacetReflection<T>::none();
    const T quarterD = density(h, h2) * S(0.25);
    if (!(value(quarterD) > 0)) return FacetReflection<T>::none();
    FacetReflection<T> r;
    r.cosHalf = ad::sqrt(T(h2 * S(0.25)));
    r.weight = masking(wo.z);
    if (distribution == FacetDistribution::kGgx) {
      r.pdf = quarterD * maskingOverCos(wi.z);
      r.pdfReverse = quarterD * maskingOverCos(wo.z);
    } else {
      // D(m) cos(m) / (4 wi.m), the same both ways.
      const T drawn = h.z * (S(2) / h2);
      r.weight = r.weight * maskingOverCos(wi.z) / drawn;
      r.pdf = r.pdfReverse = quarterD * drawn;
    }
    return r;
  }

  // The unit normal of a facet.
  template <class T>
  Vec3<T> sample(const Vec3<T>& wi, const T& u0, const T& u1) const {
    using S = Scalar<T>;
    const auto a = roughness<T>();
    const T u = awayFromPole(u0);
    if (distribution == FacetDistribution::kPhong) {
      // cos^(e + 2) = 1 - u.
      const T x = ad::log1p(T(-u)) * (S(1) / (exponent<T>() + S(2)));
      return fromPolar<T>(ad::sqrt(T(-ad::expm1(T(x * S(2))))), ad::exp(x), u1);
    }
    if (distribution == FacetDistribution::kBeckmann) {
      const T tangent = ad::sqrt(T(-ad::log1p(T(-u)))) * a;
      const T c = ad::rsqrt(T(tangent * tangent + S(1)));
      return fromPolar<T>(tangent * c, c, u1);
    }
    return sampleVisibleGgx(wi, a, a, u0, u1);
  }

  // The coordinates that draw m (of any length, m.z > 0) when seen from wi; false if none do.
  // There for plain numbers alone.
  bool invert(const Vec3<double>& wi, const Vec3<double>& m, Vec2f& u) const;

  float width() const { return std::min(kPi / 2, 2 * alpha); }

  // Below this |wi + wo|^2 both directions graze the surface from opposite sides; nothing is
  // reflected there, which leaves out a solid angle of 1e-12 and keeps float derivatives in range.
  static constexpr float kSmallestHalf2 = 1e-12f;

 private:
  static constexpr bool kTextured = ad::isDual<A>;

  template <class T>
  auto roughness() const {
    if constexpr (kTextured)
      return alpha;
    else
      return Scalar<T>(alpha);
  }
  template <class X>
  static X square(const X& x) {
    return X(x * x);
  }
  // Of Phong's cosine: from 0 on, to which a roughness above 1 leads.
  template <class T>
  auto exponent() const {
    using S = Scalar<T>;
    const auto a = roughness<T>();
    using X = std::remove_cv_t<decltype(a)>;
    return ad::max(X(S(2) / X(a * a) - S(2)), S(0));
  }
  // f(cosine, alpha), at the price of one chain rule where alpha is a number.
  template <class T, class F>
  T ofCosine(const T& cosine, F&& f) const {
    if constexpr (kTextured)
      return f(cosine, alpha);
    else
      return ofOne(cosine, [&, a = Scalar<T>(alpha)](const auto& c) { return f(c, a); });
  }

  // Whether Walter et al.'s rational approximation has G1 < 1: alpha tan > 1 / 1.6 at this cosine.
  template <class S>
  static bool isMasked(S cosine, S a) {
    return cosine * cosine < S(2.56) * a * a * (S(1) - cosine * cosine);
  }
};

using Microfacet = Facets<float>;
template <>
bool Microfacet::invert(const Vec3<double>& wi, const Vec3<double>& m, Vec2f& u) const;

inline constexpr float kSmallestRoughness = 1e-4f;

// A surface of facets, whose roughness may be a texture's.
struct FacetSurface {
  Microfacet facets;     // with the mean roughness, where that is a texture
  TexturePtr roughness;  // null: facets.alpha everywhere

  // f(Facets) with the roughness at uv.
  template <class T, class F>
  auto withFacets(const Vec2<T>& uv, F&& f) const {
    if (!roughness) [[likely]]
      return f(facets);
    if constexpr (ad::isDual<T>)
      return withTexture<T>(uv, f);
    else
      return f(facetsAt<T>(uv));
  }

 private:
  template <class T>
  Facets<T> facetsAt(const Vec2<T>& uv) const {
    return {facets.distribution,
            ad::max(scalarOf(evaluate<T>(*roughness, uv)), Scalar<T>(kSmallestRoughness))};
  }
  // Apart, so that what has no texture is not slowed down.
  template <class T, class F>
  [[gnu::noinline]] auto withTexture(const Vec2<T>& uv, F&& f) const {
    return f(facetsAt<T>(uv));
  }
};

}  // namespace h2mc
