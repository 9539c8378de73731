// SPDX-License-Identifier: MIT
// A diffuse base under a smooth dielectric coat.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/layered_diffuse.h"
#include "render/core/hemisphere.h"

namespace h2mc {

struct Plastic {
  static constexpr int kLobes = 2;
  static constexpr int kSpecular = 0, kDiffuse = 1;
  float eta = 1.5f;
  LayeredDiffuse base;
  TexturePtr specular;
  float specularScale = 1;   // of the specular reflectance, to conserve energy
  float specularWeight = 0;  // share of the specular lobe where the coat reflects half

  bool isDelta(int lobe) const { return lobe == kSpecular; }
  bool hasNonDelta() const { return true; }
  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const S invPi = kInvPiOf<T>;
    const T through = transmitDielectric(wi.z, S(eta)) * transmitDielectric(wo.z, S(eta));
    return {base.modulated<T>(uv, through * wo.z * (invPi * S(base.inverseEta2))),
            diffuseProbability(wi.z) * wo.z * invPi, diffuseProbability(wo.z) * wi.z * invPi};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    const S invPi = kInvPiOf<T>;
    const T to = transmitDielectric(wo.z, S(eta));
    const T probability = diffuseProbability(wi.z);
    if (!(value(probability) > 0)) return SampledBsdf<T>::zero();
    // The share that the coat lets in, over `probability`.
    const T entering = ofOne(wi.z, [n = S(eta), ws = S(specularWeight)](const auto& c) {
      using U = std::remove_cvref_t<decltype(c)>;
      return U(transmitDielectric(c, n) + fresnelDielectric(c, n) * (ws / (S(1) - ws)));
    });
    return {base.modulated<T>(uv, entering * to * S(base.inverseEta2)), probability * wo.z * invPi,
            diffuseProbability(wo.z) * wi.z * invPi};
  }
  float lobeSplit(const Vec2f&, const Vec3f& wi, float, float) const {
    return wi.z > 0 ? diffuseProbability(wi.z) : 1;
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    return choice < lobeSplit(uv, wi, u0, u1) ? kDiffuse : kSpecular;
  }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>&, int lobe, const T& u0, const T& u1) const {
    return lobe == kDiffuse ? sampleCosine(u0, u1) : noDirection<T>();
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const {
    if (lobe == kSpecular || !(value(wi.z) > 0 && value(wo.z) > 0)) return T(0);
    return diffuseProbability(wi.z) * wo.z * kInvPiOf<T>;
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    return lobe == kDiffuse && wi.z > 0 && invertCosine(wo, u);
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int lobe) const {
    using S = Scalar<T>;
    if (lobe != kSpecular || !(value(wi.z) > 0)) return DeltaSample<T>::none();
    const S probability = S(1) - diffuseProbability(value(wi.z));
    if (!(probability > 0)) return DeltaSample<T>::none();
    // Reflectance over that: (t (1 - ws) + f ws) / ws.
    const S ws = specularWeight;
    const T f = fresnelDielectric(wi.z, S(eta));
    const T weight = f + (S(1) - f) * ((S(1) - ws) / ws);
    const Rgb<T> r = modulate<T>(*specular, uv, weight * S(specularScale));
    return {mirrored(wi), r, r, probability};
  }
  float width(int lobe) const { return lobe == kDiffuse ? kPi / 2 : 0; }
  Rgbf albedo() const { return base.albedo() + average(*specular) * (0.05f * specularScale); }

 private:
  template <class T>
  T diffuseProbability(const T& cosine) const {
    using S = Scalar<T>;
    const S n = eta, ws = specularWeight;
    return ofOne(cosine, [n, ws](const auto& c) {
      using U = std::remove_cvref_t<decltype(c)>;
      const U t = transmitDielectric(c, n) * (S(1) - ws), f = fresnelDielectric(c, n) * ws;
      return U(t / (t + f));
    });
  }
};

}  // namespace h2mc
