// SPDX-License-Identifier: MIT
// A rough interface between two dielectrics [Walter et al. 2007].
//
// A facet is drawn first, then reflection or transmission by its Fresnel term, so a lobe is one of
// these two: the side of wo tells which one reaches it.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/microfacet.h"
#include "render/texture/texture.h"

namespace h2mc {

struct RoughDielectric : FacetSurface {
  static constexpr int kLobes = 2;
  static constexpr int kReflect = 0, kTransmit = 1;
  float eta = 1.5f;  // index of the inside (z < 0) over the outside's
  TexturePtr specularReflectance, specularTransmittance;
  float reflectanceScale = 1, transmittanceScale = 1;  // to conserve energy

  bool isDelta(int) const { return false; }
  bool hasNonDelta() const { return true; }
  bool transmits() const { return true; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    const Interaction<T> r = interaction(uv, wi, wo);
    if (!r.colour) return BsdfValue<T>::zero();
    return {modulate<T>(*r.colour, uv, r.pdf * r.weight), r.pdf, r.pdfReverse};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    const Interaction<T> r = interaction(uv, wi, wo);
    if (!r.colour) return SampledBsdf<T>::zero();
    return {modulate<T>(*r.colour, uv, r.weight), r.pdf, r.pdfReverse, r.importance};
  }

  float lobeSplit(const Vec2f& uv, const Vec3f& wi, float u0, float u1) const {
    const Vec3f in = wi.z < 0 ? flipped(wi) : wi;
    const float c = ad::dot(in, facetDrawn(uv, in, u0, u1));
    return fresnelDielectric(std::abs(c), relativeIndex<float>(wi.z));
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    return choice < lobeSplit(uv, wi, u0, u1) ? kReflect : kTransmit;
  }

  template <class T>
  Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe, const T& u0, const T& u1) const {
    using S = Scalar<T>;
    if (value(wi.z) == 0) return noDirection<T>();
    const bool inside = value(wi.z) < 0;
    const Vec3<T> in = inside ? flipped(wi) : wi;
    const Vec3<T> m = facetDrawn(uv, in, u0, u1);
    const T c = ad::dot(in, m);
    if (!(value(c) > 0)) return noDirection<T>();
    Vec3<T> out;
    if (lobe == kReflect) {
      out = m * (c * S(2)) - in;
      if (!(value(out.z) > 0)) return noDirection<T>();
    } else {
      const S inverse = S(1) / relativeIndex<S>(value(wi.z));
      const T cosFar2 = (c * c - S(1)) * (inverse * inverse) + S(1);
      if (!(value(cosFar2) > 0)) return noDirection<T>();
      out = m * (c * inverse - ad::sqrt(cosFar2)) - in * inverse;
      if (!(value(out.z) < 0)) return noDirection<T>();
    }
    return inside ? flipped(out) : out;
  }

  template <class T>
  T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const {
    const bool reflects = (value(wi.z) > 0) == (value(wo.z) > 0);
    return reflects == (lobe == kReflect) ? evaluate(uv, wi, wo).pdf : T(0);
  }

  bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    if (wi.z == 0 || wo.z == 0 || ((wi.z > 0) == (wo.z > 0)) != (lobe == kReflect)) return false;
    const double side = wi.z < 0 ? -1 : 1;
    const Vec3<double> in(wi.x, wi.y, side * wi.z), out(wo.x, wo.y, side * wo.z);
    const auto drawing = [&](const Vec3<double>& m) {
      return withFacets<float>(uv, [&](const Microfacet& f) { return f.invert(in, m, u); });
    };
    if (lobe == kReflect) return drawing(in + out);
    Vec3<double> h = in + out * relativeIndex<double>(wi.z);
    if (h.z < 0) h = -h;
    if (!(ad::dot(in, h) > 0 && ad::dot(out, h) < 0)) return false;
    return drawing(h);
  }

  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>&, const Vec3<T>&, int) const {
    return DeltaSample<T>::none();
  }
  float width(int lobe) const {
    const float bend = std::max(eta, 1 / eta) - 1;  // by which refraction turns a facet's tilt
    return lobe == kReflect ? facets.width() : std::min(kPi / 2, bend * facets.alpha);
  }
  Rgbf albedo() const { return average(*specularTransmittance) * transmittanceScale; }

 private:
  // The far side's index over the near side's.
  template <class S>
  S relativeIndex(S cosine) const {
    return cosine < 0 ? S(1) / S(eta) : S(eta);
  }

  // As SampledBsdf without the colour; none where that is null.
  template <class T>
  struct Interaction {
    T weight, pdf, pdfReverse;
    Scalar<T> importance = 1;
    const Texture* colour = nullptr;
    static Interaction none() { return {T(0), T(0), T(0)}; }
  };

  template <class T>
  Vec3<T> facetDrawn(const Vec2<T>& uv, const Vec3<T>& in, const T& u0, const T& u1) const {
    return withFacets<T>(uv, [&](const auto& f) -> Vec3<T> { return f.sample(in, u0, u1); });
  }

  template <class T>
  Interaction<T> interaction(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    const S ci = value(wi.z), co = value(wo.z);
    if (ci == 0 || co == 0) return Interaction<T>::none();
    const S relative = relativeIndex<S>(ci);
    const Vec3<T> in = ci < 0 ? flipped(wi) : wi, out = ci < 0 ? flipped(wo) : wo;
    if ((ci > 0) != (co > 0))
      return withFacets<T>(uv, [&](const auto& f) { return transmit(f, in, out, relative); });
    const FacetReflection<T> r =
        withFacets<T>(uv, [&](const auto& f) { return f.reflect(in, out); });
    if (!(value(r.pdf) > 0)) return Interaction<T>::none();
    const T f = fresnelDielectric(r.cosHalf, relative);
    return {r.weight * S(reflectanceScale), r.pdf * f, r.pdfReverse * f, S(1),
            specularReflectance.get()};
  }

  // in.z > 0 > out.z. With h = in + eta out, parallel to the facet's normal m, the Jacobian's
  // (in.m + eta out.m)^2 [Walter et al., eq. 17] is |h|^2.
  template <class T, class A>
  Interaction<T> transmit(const Facets<A>& surface, const Vec3<T>& in, const Vec3<T>& out,
                          Scalar<T> relative) const {
    using S = Scalar<T>;
    Vec3<T> h = in + out * relative;
    if (value(h.z) < 0) h = -h;
    const T h2 = ad::length2(h);
    if (!(value(h2) > Microfacet::kSmallestHalf2 && value(h.z) > 0)) return Interaction<T>::none();
    const T inverse = ad::rsqrt(h2);
    const T ci = ad::dot(in, h) * inverse, co = ad::dot(out, h) * -inverse;
    if (!(value(ci) > 0 && value(co) > 0)) return Interaction<T>::none();
    const T d = surface.density(h, h2);
    if (!(value(d) > 0)) return Interaction<T>::none();
    const T down = -out.z;
    const T shared = d * transmitDielectric(ci, co, relative) / h2;
    const S relative2 = relative * relative;
    Interaction<T> r;
    // Radiance is divided by relative^2 as it enters the denser side, which eq. 21 multiplies by.
    r.weight = surface.masking(down) * (S(transmittanceScale) / relative2);
    r.importance = relative2;
    if (surface.distribution == FacetDistribution::kGgx) {
      const T seen = shared * ci * co;
      r.pdf = seen * surface.maskingOverCos(in.z) * relative2;
      r.pdfReverse = seen * surface.maskingOverCos(down);
    } else {
      const T tilt = h.z * inverse;
      const T drawn = shared * tilt;
      r.weight = r.weight * surface.maskingOverCos(in.z) * ci / tilt;
      r.pdf = drawn * co * relative2;
      r.pdfReverse = drawn * ci;
    }
    if (value(r.pdf) > 0) r.colour = specularTransmittance.get();
    return r;
  }
};

}  // namespace h2mc
