// SPDX-License-Identifier: MIT
// A diffuse base under a rough dielectric coat.
#pragma once

#include <memory>

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/layered_diffuse.h"
#include "render/bsdf/microfacet.h"
#include "render/bsdf/rough_transmittance.h"

namespace h2mc {

struct RoughPlastic {
  static constexpr int kLobes = 2;
  static constexpr int kSpecular = 0, kDiffuse = 1;
  Microfacet facets;
  float eta = 1.5f;
  std::shared_ptr<const RoughTransmittance> transmittance;
  LayeredDiffuse base;
  TexturePtr specular;
  float specularScale = 1;   // of the specular reflectance, to conserve energy
  float specularWeight = 0;  // share of the specular lobe where the coat reflects half

  bool isDelta(int) const { return false; }
  bool hasNonDelta() const { return true; }
  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    BsdfValue<T> r = BsdfValue<T>::zero();
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return r;
    const S invPi = kInvPiOf<T>;
    const T ti = transmittance->evaluate(wi.z), to = transmittance->evaluate(wo.z);
    const T di = diffuseProbability(ti), dd = diffuseProbability(to);
    r.value = base.modulated<T>(uv, ti * to * wo.z * (invPi * S(base.inverseEta2)));
    r.pdf = di * wo.z * invPi;
    r.pdfReverse = dd * wi.z * invPi;
    const FacetReflection<T> coat = facets.reflect(wi, wo);
    if (value(coat.pdf) > 0) {
      const T f = fresnelDielectric(coat.cosHalf, S(eta));
      r.value = r.value + modulate<T>(*specular, uv, coat.pdf * coat.weight * f * S(specularScale));
      r.pdf = r.pdf + coat.pdf * (S(1) - di);
      r.pdfReverse = r.pdfReverse + coat.pdfReverse * (S(1) - dd);
    }
    return r;
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    SampledBsdf<T> r = SampledBsdf<T>::zero();
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return r;
    const S invPi = kInvPiOf<T>;
    const T ti = transmittance->evaluate(wi.z), to = transmittance->evaluate(wo.z);
    const T di = diffuseProbability(ti), dd = diffuseProbability(to);
    const T ds = S(1) - di, cosine = wo.z * invPi;
    const T inner = ti * to * S(base.inverseEta2);
    const FacetReflection<T> coat = facets.reflect(wi, wo);
    r.pdf = di * cosine + coat.pdf * ds;
    if (!(value(r.pdf) > 0)) return r;
    r.pdfReverse = dd * wi.z * invPi + coat.pdfReverse * (S(1) - dd);
    const MixtureShares<T> shares(cosine, coat.pdf, di, ds);
    r.weight = base.modulated<T>(uv, inner * shares.first);
    if (value(coat.pdf) > 0) {
      const T f = fresnelDielectric(coat.cosHalf, S(eta));
      r.weight =
          r.weight + modulate<T>(*specular, uv, coat.weight * f * shares.second * S(specularScale));
    }
    return r;
  }
  float lobeSplit(const Vec2f&, const Vec3f& wi, float, float) const {
    return wi.z > 0 ? diffuseProbability(transmittance->evaluate(wi.z)) : 1;
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    return choice < lobeSplit(uv, wi, u0, u1) ? kDiffuse : kSpecular;
  }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>& wi, int lobe, const T& u0, const T& u1) const {
    if (lobe == kDiffuse) return sampleCosine(u0, u1);
    if (!(value(wi.z) > 0)) return noDirection<T>();
    const Vec3<T> m = facets.sample(wi, u0, u1);
    return m * (ad::dot(wi, m) * Scalar<T>(2)) - wi;
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return T(0);
    const T d = diffuseProbability(transmittance->evaluate(wi.z));
    return lobe == kDiffuse ? T(d * wo.z * kInvPiOf<T>)
                            : T(facets.reflect(wi, wo).pdf * (S(1) - d));
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    if (!(wi.z > 0 && wo.z > 0)) return false;
    if (lobe == kDiffuse) return invertCosine(wo, u);
    const Vec3<double> in(wi);
    return facets.invert(in, in + Vec3<double>(wo), u);
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>&, const Vec3<T>&, int) const {
    return DeltaSample<T>::none();
  }
  float width(int lobe) const { return lobe == kDiffuse ? kPi / 2 : facets.width(); }
  Rgbf albedo() const { return base.albedo() + average(*specular) * (0.05f * specularScale); }

 private:
  // Of the diffuse lobe, where the coat lets the share t through.
  template <class T>
  T diffuseProbability(const T& through) const {
    using S = Scalar<T>;
    const S ws = specularWeight;
    return ofOne(through, [ws](const auto& t) {
      using U = std::remove_cvref_t<decltype(t)>;
      const U d = t * (S(1) - ws);
      return U(d / (d + (S(1) - t) * ws));
    });
  }
};

}  // namespace h2mc
