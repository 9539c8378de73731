// SPDX-License-Identifier: MIT
// A rough interface between two dielectrics [Walter et al. 2007].
//
// A facet is drawn first, then reflection or transmission by its Fresnel term, so a lobe is one of
// these two: the side of wo tells which one reaches it.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/facet_interface.h"
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
    const Vec3<T> out = leaveFacet(in, m, lobe == kReflect, relativeIndex<S>(value(wi.z)));
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
    Vec3<double> h;
    if (!facetBetween(in, out, lobe == kReflect, relativeIndex<double>(wi.z), h)) return false;
    return withFacets<float>(uv, [&](const Microfacet& f) { return f.invert(in, h, u); });
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
      return transmission(withFacets<T>(uv,
                                        [&](const auto& f) {
                                          return transmitFacets(f, in, out, relative,
                                                                S(transmittanceScale));
                                        }),
                          relative);
    const FacetReflection<T> r =
        withFacets<T>(uv, [&](const auto& f) { return f.reflect(in, out); });
    if (!(value(r.pdf) > 0)) return Interaction<T>::none();
    const T f = fresnelDielectric(r.cosHalf, relative);
    return {r.weight * S(reflectanceScale), r.pdf * f, r.pdfReverse * f, S(1),
            specularReflectance.get()};
  }

  template <class T>
  Interaction<T> transmission(const FacetTransmission<T>& t, Scalar<T> relative) const {
    if (!(value(t.pdf) > 0)) return Interaction<T>::none();
    return {t.weight, t.pdf, t.pdfReverse, relative * relative, specularTransmittance.get()};
  }
};

}  // namespace h2mc
