// SPDX-License-Identifier: MIT
// The principled BSDF [Burley 2012, "Physically Based Shading at Disney"; Burley 2015, "Extending the Disney BRDF to a
// BSDF with Integrated Subsurface Scattering"], as Mitsuba 3 has it: facets that reflect and, by the share `specTrans`,
// refract; a diffuse base with retro-reflection, or a flatter one; sheen; a clear coat. What is refracted goes through
// to the other side, where there are the facets alone.
//
// The parts are added up as there, which keeps no books of energy: at grazing angles more may be reflected than arrives
// (docs/limits.md says how much).
#pragma once

#include "render/bsdf/facet_interface.h"
#include "render/bsdf/lobe_kinds.h"
#include "render/bsdf/principled_values.h"
#include "render/core/safe_math.h"

namespace h2mc {

struct Principled : PrincipledSurface, NonDeltaLobes {
  static constexpr int kLobes = 4;
  static constexpr int kReflect = 0, kTransmit = 1, kCoat = 2, kDiffuse = 3;
  float eta = 1.5f;         // index of the inside (z < 0) over the outside's
  bool refracts = false;    // specTrans is not 0 everywhere
  bool isIsotropic = true;  // anisotropic is 0 everywhere

  bool transmits() const { return refracts; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    return withValues<T>(uv, [&](const auto& v) { return evaluateWith<T>(v, wi, wo); });
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    return withValues<T>(uv, [&](const auto& v) { return sampledWith<T>(v, wi, wo); });
  }

  ChoiceInterval choiceInterval(const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                int lobe) const {
    const Splits s = splits(uv, wi, u0, u1);
    switch (lobe) {
      case kDiffuse:
        return {0, s.diffuse};
      case kCoat:
        return {s.diffuse, s.coat};
      case kTransmit:
        return {s.coat, s.transmit};
      default:
        return {s.transmit, 1};
    }
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    const Splits s = splits(uv, wi, u0, u1);
    if (choice < s.diffuse) return kDiffuse;
    if (choice < s.coat) return kCoat;
    return choice < s.transmit ? kTransmit : kReflect;
  }

  template <class T>
  Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe, const T& u0, const T& u1) const {
    using S = Scalar<T>;
    const S side = value(wi.z);
    if (lobe == kDiffuse) return sampleCosine(u0, u1);
    if (side == 0 || (side < 0 && (lobe == kCoat || !refracts))) return noDirection<T>();
    return withValues<T>(uv, [&](const auto& v) -> Vec3<T> {
      if (lobe == kCoat) return leaveFacet(wi, v.coat().sample(u0, u1), true, S(1));
      const Vec3<T> in = side < 0 ? flipped(wi) : wi;
      const Vec3<T> m = v.facets().sample(in, u0, u1);
      const Vec3<T> out = leaveFacet(in, m, lobe == kReflect, relativeIndex<S>(side));
      return side < 0 ? flipped(out) : out;
    });
  }

  template <class T>
  T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const {
    return withValues<T>(uv, [&](const auto& v) -> T {
      using S = Scalar<T>;
      const bool reflects = (value(wi.z) > 0) == (value(wo.z) > 0);
      if (reflects == (lobe == kTransmit)) return T(S(0));
      if (!(value(wi.z) > 0 && value(wo.z) > 0))
        return lobe <= kTransmit ? evaluateWith<T>(v, wi, wo).pdf : T(S(0));
      const auto shares = v.shares();
      if (lobe == kDiffuse) return wo.z * kInvPiOf<T> * shares.diffuse;
      const Outside<T> o = outside<T>(v, wi, wo);
      return lobe == kCoat ? T(o.coatPdf * shares.coat) : T(o.facets.pdf * o.drawn * shares.facets);
    });
  }

  bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    if (wi.z == 0 || wo.z == 0 || ((wi.z > 0) == (wo.z > 0)) != (lobe != kTransmit)) return false;
    if (wi.z < 0 && (lobe >= kCoat || !refracts)) return false;
    if (lobe == kDiffuse) return invertCosine(wo, u);
    const double side = wi.z < 0 ? -1 : 1;
    const Vec3<double> in(wi.x, wi.y, side * wi.z), out(wo.x, wo.y, side * wo.z);
    Vec3<double> h;
    if (!facetBetween(in, out, lobe != kTransmit, relativeIndex<double>(wi.z), h)) return false;
    return withValues<float>(uv, [&](const auto& v) {
      return lobe == kCoat ? v.coat().invert(h, u) : v.facets().invert(in, h, u);
    });
  }

  float width(int lobe) const {
    if (lobe == kDiffuse) return kPi / 2;
    const AnisotropicFacets<float> facets = means.facets();
    const float alpha = lobe == kCoat ? means.coat().alpha : std::min(facets.alphaX, facets.alphaY);
    // What refraction turns a facet's tilt by.
    const float turn = lobe == kTransmit ? std::max(eta, 1 / eta) - 1 : 2;
    return std::min(kPi / 2, turn * alpha);
  }
  Rgbf albedo() const { return means.color; }

 private:
  // Where the choices of the lobes end, in the order diffuse, coat, transmission; reflection has the rest.
  struct Splits {
    float diffuse = 0, coat = 0, transmit = 0;
  };
  Splits splits(const Vec2f& uv, const Vec3f& wi, float u0, float u1) const {
    return withValues<float>(uv, [&](const auto& v) {
      Splits s;
      const bool inside = wi.z < 0;
      float facets = 1, refracting = 1;
      if (!inside) {
        const auto shares = v.shares();
        s.diffuse = shares.diffuse;
        s.coat = s.diffuse + shares.coat;
        facets = shares.facets;
        refracting = v.refracting();
      }
      s.transmit = s.coat;
      if (!refracts || wi.z == 0 || !(refracting > 0)) return s;
      const Vec3f in = inside ? flipped(wi) : wi;
      const float cosine = ad::dot(in, v.facets().sample(in, u0, u1));
      if (cosine > 0)
        s.transmit += facets * refracting * transmitDielectric(cosine, relativeIndex<float>(wi.z));
      return s;
    });
  }

  // The far side's index over the near side's.
  template <class S>
  S relativeIndex(S cosine) const {
    return cosine < 0 ? S(1) / S(eta) : S(eta);
  }

  // Both directions above: each part's density of wo, and of the facets and the coat what they scatter, over that.
  template <class T>
  struct Outside {
    FacetReflection<T> facets;
    T drawn;  // share of the facets that reflect and are not drawn to refract
    Rgb<T> reflected;
    T coatPdf, coatWeight;
  };
  template <class T, class P>
  Outside<T> outside(const PrincipledValues<P>& v, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    Outside<T> o;
    o.coatPdf = o.coatWeight = T(S(0));
    o.facets = v.facets().reflect(wi, wo);
    o.reflected = lift<T>(Vec3<S>(0));
    o.drawn = T(S(1));
    if (!(value(o.facets.pdf) > 0)) return o;
    const T& cosHalf = o.facets.cosHalf;
    const T schlick = schlickWeight(cosHalf);
    if (eta != 1) {
      const T fresnel = fresnelDielectric(cosHalf, S(eta));
      if (refracts) o.drawn = S(1) - v.refracting() * transmitDielectric(cosHalf, S(eta));
      o.reflected = coloured<T>(v, fresnel, schlick) * o.facets.weight;
    }
    if (isNothing(v.clearcoat)) return o;
    const Vec3<T> h = wi + wo;
    const T h2 = ad::square(cosHalf) * S(4);
    o.coatPdf = v.coat().pdf(h);
    // D F G cos(wo) / 4 over that, without the 1 / (cos(wi) cos(wo)) of other facets, as in Mitsuba 3.
    const Microfacet masks{FacetDistribution::kGgx, 0.25f};
    o.coatWeight = (schlick * S(0.96) + S(0.04)) * masks.masking(wi.z) * masks.masking(wo.z) *
                   wo.z * (h2 * S(0.5) / h.z) * v.clearcoat;
    return o;
  }
  // Of the facets outside [Burley 2012, section 5.5]: the metal's reflectance and the tinted one by Schlick's
  // approximation, the rest by Fresnel's formula.
  template <class T, class P>
  Rgb<T> coloured(const PrincipledValues<P>& v, const T& fresnel, const T& schlick) const {
    using S = Scalar<T>;
    if (isNothing(v.metallic) && isNothing(v.specTint)) return Rgb<T>(fresnel, fresnel, fresnel);
    const S normal = (S(eta) - S(1)) / (S(eta) + S(1));
    const P tinted = (S(1) - v.metallic) * v.specTint;
    const P plain = (S(1) - v.metallic) * (S(1) - v.specTint);
    const Vec3<P> straight = v.color * v.metallic + v.tint() * P(tinted * (normal * normal));
    const T white = fresnel * plain + schlick * P(v.metallic + tinted);
    const T rest = S(1) - schlick;
    return {white + rest * straight.x, white + rest * straight.y, white + rest * straight.z};
  }
  // (1 - c)^5 of the cosine on the thinner side [Schlick 1994, "An Inexpensive BRDF Model for Physically-based
  // Rendering"].
  template <class T>
  T schlickWeight(const T& cosine) const {
    using S = Scalar<T>;
    const S ratio2 = S(1) / (S(eta) * S(eta));
    return ofOne(cosine, [thinner = eta > 1, ratio2](const auto& c) {
      using U = std::remove_cvref_t<decltype(c)>;
      if (thinner) return fifthPower(U(S(1) - c));
      return fifthPower(U(S(1) - safeSqrt(U((c * c - S(1)) * ratio2 + S(1)))));
    });
  }
  template <class T>
  static T fifthPower(const T& x) {
    const T y = ad::max(x, Scalar<T>(0)), y2 = y * y;
    return y2 * y2 * y;
  }

  // Base and sheen, over cos(wo) / pi [Burley 2012, sections 5.3 and 5.6; 2015, section 3].
  template <class T, class P>
  Rgb<T> diffused(const PrincipledValues<P>& v, const T& cosHalf, const T& ci, const T& co) const {
    using S = Scalar<T>;
    const T fi = fifthPower(T(S(1) - ci)), fo = fifthPower(T(S(1) - co));
    const T retro = ad::square(cosHalf) * v.roughness * S(2);
    T rough =
        (S(1) - fi * S(0.5)) * (S(1) - fo * S(0.5)) + retro * (fo + fi + fo * fi * (retro - S(1)));
    if (!isNothing(v.flatness)) {
      const T flat90 = retro * S(0.5) - S(1);
      const T edge = (fo * flat90 + S(1)) * (fi * flat90 + S(1));
      const T sum = ad::max(T(ci + co), S(1e-6));
      const T flat = (edge * (S(1) / sum - S(0.5)) + S(0.5)) * S(1.25);
      rough = rough + (flat - rough) * v.flatness;
    }
    rough = rough * v.base();
    Rgb<T> r{rough * v.color.x, rough * v.color.y, rough * v.color.z};
    if (isNothing(v.sheen)) return r;
    const T sheen =
        fifthPower(T(S(1) - cosHalf)) * P(v.sheen * (S(1) - v.metallic) * S(std::numbers::pi));
    const Vec3<P> tint = v.tint();
    for (int k = 0; k < 3; ++k) r[k] = r[k] + sheen * P((tint[k] - S(1)) * v.sheenTint + S(1));
    return r;
  }

  template <class T, class P>
  BsdfValue<T> evaluateWith(const PrincipledValues<P>& v, const Vec3<T>& wi,
                            const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) {
      const Through<T> t = through<T>(v, wi, wo);
      return {t.weight * t.pdf, t.pdf, t.pdfReverse};
    }
    const auto shares = v.shares();
    const Outside<T> o = outside<T>(v, wi, wo);
    const S invPi = kInvPiOf<T>;
    const T facets = o.drawn * shares.facets;
    BsdfValue<T> r;
    r.value =
        diffused<T>(v, o.facets.cosHalf, wi.z, wo.z) * T(wo.z * invPi) + o.reflected * o.facets.pdf;
    r.pdf = wo.z * (shares.diffuse * invPi) + o.facets.pdf * facets;
    r.pdfReverse = wi.z * (shares.diffuse * invPi) + o.facets.pdfReverse * facets;
    if (value(o.coatPdf) > 0) {
      const T coat = o.coatPdf * o.coatWeight, drawn = o.coatPdf * shares.coat;
      for (int k = 0; k < 3; ++k) r.value[k] = r.value[k] + coat;
      r.pdf = r.pdf + drawn;
      r.pdfReverse = r.pdfReverse + drawn;
    }
    return r;
  }

  template <class T, class P>
  SampledBsdf<T> sampledWith(const PrincipledValues<P>& v, const Vec3<T>& wi,
                             const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return through<T>(v, wi, wo);
    const auto shares = v.shares();
    const Outside<T> o = outside<T>(v, wi, wo);
    const T cosine = wo.z * kInvPiOf<T>;
    const T facets = o.drawn * shares.facets;
    const T others = cosine * shares.diffuse + o.coatPdf * shares.coat;
    SampledBsdf<T> r = SampledBsdf<T>::zero();
    r.pdf = o.facets.pdf * facets + others;
    if (!(value(r.pdf) > 0)) return r;
    r.pdfReverse = wi.z * (shares.diffuse * kInvPiOf<T>)+o.coatPdf * shares.coat +
                   o.facets.pdfReverse * facets;
    // What the facets' density and the others' are of all, then the two others' of theirs.
    const MixtureShares<T> parts(o.facets.pdf, others, facets, S(1));
    r.weight = o.reflected * parts.first;
    if (!(value(others) > 0)) return r;
    const Rgb<T> diffuse = diffused<T>(v, o.facets.cosHalf, wi.z, wo.z);
    const MixtureShares<T> rest(o.coatPdf, cosine, shares.coat, shares.diffuse);
    r.weight = r.weight + diffuse * T(rest.second * parts.second);
    if (value(o.coatPdf) > 0) {
      const T coat = o.coatWeight * rest.first * parts.second;
      for (int k = 0; k < 3; ++k) r.weight[k] = r.weight[k] + coat;
    }
    return r;
  }

  // Any two directions that are not both above.
  template <class T>
  using Through = SampledBsdf<T>;
  template <class T, class P>
  Through<T> through(const PrincipledValues<P>& v, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    const S ci = value(wi.z), co = value(wo.z);
    const P refracting = v.refracting();
    if (ci == 0 || co == 0 || !refracts || !(value(refracting) > 0)) return Through<T>::zero();
    const S relative = relativeIndex<S>(ci);
    const Vec3<T> in = ci < 0 ? flipped(wi) : wi, out = ci < 0 ? flipped(wo) : wo;
    if ((ci > 0) == (co > 0)) {
      const FacetReflection<T> f = v.facets().reflect(in, out);
      if (!(value(f.pdf) > 0)) return Through<T>::zero();
      const T fresnel = fresnelDielectric(f.cosHalf, relative);
      const T weight = f.weight * refracting;
      return {Rgb<T>(weight, weight, weight), f.pdf * fresnel, f.pdfReverse * fresnel};
    }
    const FacetTransmission<T> f = transmitFacets(v.facets(), in, out, relative, S(1));
    if (!(value(f.pdf) > 0)) return Through<T>::zero();
    // Outside, the share that refracts is a part of the lobe's probability; inside it is 1 and the share a factor.
    const P drawn = v.shares().facets * refracting;
    const Vec3<P> color(safeSqrt(v.color.x), safeSqrt(v.color.y), safeSqrt(v.color.z));
    Through<T> r;
    r.importance = relative * relative;
    if (ci > 0) {
      r.weight = color * T(f.weight / v.shares().facets);
      r.pdf = f.pdf * drawn;
      r.pdfReverse = f.pdfReverse;
    } else {
      r.weight = color * T(f.weight * refracting);
      r.pdf = f.pdf;
      r.pdfReverse = f.pdfReverse * drawn;
    }
    return r;
  }

  // Nothing of it is seen, nor would be at a neighbouring point.
  template <class P>
  static bool isNothing(const P& x) {
    if constexpr (ad::isDual<P>)
      return false;
    else
      return x == 0;
  }
};

}  // namespace h2mc
