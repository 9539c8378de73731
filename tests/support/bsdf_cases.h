// BSDFs that the tests try everything on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/bsdf/material.h"

namespace h2mc::test {

struct BsdfCase {
  std::string name;
  Bsdf bsdf;
  bool entersBack = false;  // light from z < 0 scatters too
};

inline Microfacet facets(FacetDistribution distribution, float alpha) {
  return {distribution, alpha};
}
constexpr auto kGgx = FacetDistribution::kGgx;
constexpr auto kBeckmann = FacetDistribution::kBeckmann;

inline TexturePtr gray(float x) { return constantTexture(Rgbf(x)); }

inline Diffuse diffuse(const Rgbf& color) {
  Diffuse b;
  b.reflectance = constantTexture(color);
  return b;
}
inline Phong phong(float kd, float ks, float exponent) {
  Phong b;
  b.diffuse = gray(kd);
  b.specular = gray(ks);
  b.exponent = exponent;
  b.specularWeight = ks / (kd + ks);
  return b;
}
inline ConductorIndex gold() { return {{0.143f, 0.375f, 1.442f}, {3.98f, 2.39f, 1.6f}, false}; }
inline RoughConductor roughConductor(Microfacet f, ConductorIndex index = ConductorIndex{}) {
  RoughConductor b;
  b.facets = f;
  b.index = index;
  b.specular = gray(1);
  return b;
}
inline Conductor conductor(ConductorIndex index = ConductorIndex{}) {
  Conductor b;
  b.index = index;
  b.specular = gray(1);
  return b;
}
template <class B>
B interface(B b, float eta) {
  b.eta = eta;
  b.specularReflectance = b.specularTransmittance = gray(1);
  return b;
}
inline Dielectric dielectric(float eta) { return interface(Dielectric{}, eta); }
inline RoughDielectric roughDielectric(Microfacet f, float eta) {
  RoughDielectric b;
  b.facets = f;
  return interface(b, eta);
}
inline Plastic plastic(const Rgbf& color, float eta, bool nonlinear) {
  Plastic b;
  b.eta = eta;
  b.specular = gray(1);
  b.specularWeight = 1 / (1 + luminance(color));
  b.base = LayeredDiffuse(constantTexture(color), 1, fresnelDiffuse(1.0 / eta), eta, nonlinear);
  return b;
}
inline RoughPlastic roughPlastic(Microfacet f, const Rgbf& color, float eta, bool nonlinear) {
  RoughPlastic b;
  b.facets = f;
  b.eta = eta;
  b.specular = gray(1);
  b.specularWeight = 1 / (1 + luminance(color));
  b.transmittance = RoughTransmittance::shared(f, eta);
  b.base = LayeredDiffuse(constantTexture(color), 1, b.transmittance->internalReflectance(), eta,
                          nonlinear);
  return b;
}

inline Material material(int front, int back = -1, bool twosided = false,
                         TexturePtr opacity = nullptr) {
  Material m;
  m.front = front;
  m.back = back;
  m.twosided = twosided;
  m.opacity = std::move(opacity);
  return m;
}

// Every kind of BSDF with lobes that are not delta, from mirror-like to rough.
inline const std::vector<BsdfCase>& glossyCases() {
  static const std::vector<BsdfCase> cases = {
      {"diffuse", diffuse({0.2f, 0.5f, 0.8f})},
      {"phong 5", phong(0.3f, 0.5f, 5)},
      {"phong 200", phong(0.5f, 0.45f, 200)},
      {"roughconductor ggx 0.5", roughConductor(facets(kGgx, 0.5f), gold())},
      {"roughconductor ggx 0.1", roughConductor(facets(kGgx, 0.1f), gold())},
      {"roughconductor beckmann 0.4", roughConductor(facets(kBeckmann, 0.4f), gold())},
      {"roughconductor beckmann 0.08", roughConductor(facets(kBeckmann, 0.08f), gold())},
      {"roughconductor ggx 0.01", roughConductor(facets(kGgx, 0.01f), gold())},
      {"roughconductor beckmann 0.01", roughConductor(facets(kBeckmann, 0.01f), gold())},
      {"roughconductor none", roughConductor(facets(kGgx, 0.3f))},
      {"roughdielectric ggx 0.4", roughDielectric(facets(kGgx, 0.4f), 1.5f), true},
      {"roughdielectric ggx 0.1", roughDielectric(facets(kGgx, 0.1f), 1.5f), true},
      {"roughdielectric beckmann 0.3", roughDielectric(facets(kBeckmann, 0.3f), 1.5f), true},
      {"roughdielectric beckmann 0.1", roughDielectric(facets(kBeckmann, 0.1f), 1.33f), true},
      {"roughdielectric inverted", roughDielectric(facets(kGgx, 0.2f), 1 / 1.5f), true},
      {"plastic", plastic({0.6f, 0.3f, 0.1f}, 1.5f, true)},
      {"roughplastic ggx 0.15", roughPlastic(facets(kGgx, 0.15f), {0.6f, 0.3f, 0.1f}, 1.5f, true)},
      {"roughplastic beckmann 0.3",
       roughPlastic(facets(kBeckmann, 0.3f), {0.6f, 0.3f, 0.1f}, 1.49f, false)},
  };
  return cases;
}

inline Vec3f direction(float cosine, float azimuth) {
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace h2mc::test
