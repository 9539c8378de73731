// SPDX-License-Identifier: MIT
// A rough metal: reflection by conducting microfacets.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/conductor_index.h"
#include "render/bsdf/microfacet.h"
#include "render/texture/texture.h"

namespace h2mc {

struct RoughConductor : FacetSurface {
  static constexpr int kLobes = 1;
  ConductorIndex index;
  TexturePtr specular;
  float scale = 1;  // of the specular reflectance, to conserve energy

  bool isDelta(int) const { return false; }
  bool hasNonDelta() const { return true; }
  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const FacetReflection<T> r = reflection(uv, wi, wo);
    if (!(value(r.pdf) > 0)) return BsdfValue<T>::zero();
    return {coloured<T>(uv, r.pdf * r.weight, r.cosHalf), r.pdf, r.pdfReverse};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    const FacetReflection<T> r = reflection(uv, wi, wo);
    if (!(value(r.pdf) > 0)) return SampledBsdf<T>::zero();
    return {coloured<T>(uv, r.weight, r.cosHalf), r.pdf, r.pdfReverse};
  }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int, const T& u0, const T& u1) const {
    if (!(value(wi.z) > 0)) return noDirection<T>();
    const Vec3<T> m =
        withFacets<T>(uv, [&](const auto& f) -> Vec3<T> { return f.sample(wi, u0, u1); });
    return m * (ad::dot(wi, m) * Scalar<T>(2)) - wi;
  }
  template <class T>
  T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo, int) const {
    return value(wi.z) > 0 && value(wo.z) > 0 ? reflection(uv, wi, wo).pdf : T(0);
  }
  bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int, Vec2f& u) const {
    if (!(wi.z > 0 && wo.z > 0)) return false;
    const Vec3<double> in(wi);
    return withFacets<float>(
        uv, [&](const Microfacet& f) { return f.invert(in, in + Vec3<double>(wo), u); });
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>&, const Vec3<T>&, int) const {
    return DeltaSample<T>::none();
  }
  float width(int) const { return facets.width(); }
  Rgbf albedo() const { return index.reflect<float>(average(*specular) * scale, 0.8f); }

 private:
  template <class T>
  FacetReflection<T> reflection(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    return withFacets<T>(uv, [&](const auto& f) { return f.reflect(wi, wo); });
  }
  template <class T>
  Rgb<T> coloured(const Vec2<T>& uv, const T& amount, const T& cosHalf) const {
    return index.reflect(modulate<T>(*specular, uv, amount * Scalar<T>(scale)), cosHalf);
  }
};

}  // namespace h2mc
