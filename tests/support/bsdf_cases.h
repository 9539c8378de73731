// SPDX-License-Identifier: MIT
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
constexpr auto kPhong = FacetDistribution::kPhong;

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
// `recent`: as in files of version 2 and later.
inline RoughPlastic roughPlastic(Microfacet f, const Rgbf& color, float eta, bool nonlinear,
                                 bool recent = false) {
  RoughPlastic b;
  b.facets = f;
  b.eta = eta;
  b.specular = gray(1);
  b.specularWeight = 1 / (1 + luminance(color));
  b.transmittance = RoughTransmittance::shared(f, eta);
  b.base = LayeredDiffuse(constantTexture(color), 1,
                          recent ? RoughTransmittance::facetsInternalReflectance(f, eta)
                                 : b.transmittance->internalReflectance(),
                          eta, nonlinear);
  return b;
}

// Two by two texels, black and white turned a bit to the middle: its derivatives are not zero.
inline TexturePtr picture(float low, float high) {
  auto image = std::make_shared<Image>(2, 2);
  image->pixels = {Rgbf(low), Rgbf(high), Rgbf(high), Rgbf(low)};
  BitmapTexture t;
  t.image = image;
  return std::make_shared<const Texture>(t);
}
template <class B>
B textured(B b, float low, float high) {
  b.roughness = picture(low, high);
  return b;
}
inline FurtherBsdf diffuseTransmitter(const Rgbf& color) {
  DiffuseTransmitter b;
  b.transmittance = constantTexture(color);
  return {b};
}
inline FurtherBsdf roughDiffuse(const Rgbf& color, float sigma, bool fast) {
  RoughDiffuse b;
  b.reflectance = constantTexture(color);
  b.sigma = sigma;
  b.fast = fast;
  return {b};
}
inline FurtherBsdf ward(WardVariant variant, float alphaU, float alphaV, float kd, float ks) {
  Ward b;
  b.variant = variant;
  b.alphaU = alphaU;
  b.alphaV = alphaV;
  b.diffuse = gray(kd);
  b.specular = gray(ks);
  b.specularWeight = ks / (kd + ks);
  return {b};
}
inline FurtherBsdf thinDielectric(float eta) { return {interface(ThinDielectric{}, eta)}; }

// `sigma`: of the layer, for its thickness.
template <class Interface>
FurtherBsdf coat(Interface interface, Bsdf below, const Rgbf& sigma = Rgbf(0)) {
  Coat<Interface> b;
  b.interface = std::move(interface);
  b.below = std::make_shared<const CoatedBsdf>(std::move(below));
  if (sigma != Rgbf(0)) b.absorption = constantTexture(sigma);
  b.thickness = 0.8f;
  b.specular = gray(1);
  b.specularWeight = 0.6f;
  return {b};
}
inline FurtherBsdf coating(float eta, Bsdf below, const Rgbf& sigma = Rgbf(0)) {
  return coat(SmoothInterface{eta}, std::move(below), sigma);
}
inline FurtherBsdf roughCoating(Microfacet f, float eta, Bsdf below, const Rgbf& sigma = Rgbf(0)) {
  return coat(RoughInterface{eta, f, RoughTransmittance::shared(f, eta)}, std::move(below), sigma);
}
// All parameters but the colour in the order of PrincipledValues.
inline Principled principled(const Rgbf& color, const float (&numbers)[Principled::kNumbers],
                             float eta = 1.5f) {
  Principled b;
  b.means = PrincipledValues<float>(color, [&](int i) { return numbers[i]; });
  b.isIsotropic = numbers[1] == 0;
  b.refracts = numbers[3] > 0;
  b.eta = eta;
  return b;
}
// The same with textures around these values.
inline Principled textured(Principled b, const float (&numbers)[Principled::kNumbers]) {
  Principled::Textures textures;
  textures.color = std::make_shared<const Texture>(
      ProductTexture{constantTexture(b.means.color), picture(0.7f, 1.2f)});
  for (int i = 0; i < Principled::kNumbers; ++i)
    textures.numbers[i] = picture(0.7f * numbers[i], 1.2f * numbers[i]);
  b.textures = std::make_shared<const Principled::Textures>(textures);
  return b;
}
// roughness, anisotropic, metallic, specTrans, specTint, sheen, sheenTint, flatness, clearcoat, clearcoatGloss
constexpr float kPrincipledCloth[] = {0.6f, 0, 0, 0, 0.5f, 0.5f, 0.4f, 0.6f, 0, 0};
constexpr float kPrincipledLacquer[] = {0.5f, 0, 0.2f, 0, 0, 0, 0, 0, 0.8f, 0.3f};
constexpr float kPrincipledMetal[] = {0.45f, 0.8f, 1, 0, 0, 0, 0, 0, 0, 0};
constexpr float kPrincipledGlass[] = {0.5f, 0, 0, 1, 0, 0, 0, 0, 0, 0};
constexpr float kPrincipledAll[] = {0.5f, 0.4f, 0.3f, 0.5f, 0.4f, 0.3f, 0.6f, 0.4f, 0.5f, 0.2f};

// At the ends of their ranges: as smooth as can be, as rough, and black, with everything on.
inline std::vector<BsdfCase> extremePrincipled() {
  constexpr float kSmooth[] = {0, 1, 0.5f, 0.5f, 1, 1, 1, 1, 1, 1};
  constexpr float kRough[] = {1, 0, 0, 0.5f, 0, 1, 0, 1, 1, 0};
  constexpr float kMirror[] = {0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  return {{"principled smooth", FurtherBsdf{principled(Rgbf(1), kSmooth)}, true},
          {"principled smooth inside", FurtherBsdf{principled(Rgbf(1), kSmooth, 0.6f)}, true},
          {"principled rough", FurtherBsdf{principled(Rgbf(1), kRough)}, true},
          {"principled black", FurtherBsdf{principled(Rgbf(0), kSmooth)}, true},
          {"principled nearly air", FurtherBsdf{principled(Rgbf(0.5f), kRough, 1.001f)}, true},
          {"principled mirror", FurtherBsdf{principled(Rgbf(1), kMirror)}},
          {"principled without an index", FurtherBsdf{principled(Rgbf(1), kMirror, 1)}},
          {"principled textured to black",
           FurtherBsdf{textured(principled(Rgbf(0), kSmooth), kSmooth)}, true}};
}

// The index of what lies behind a rough interface, over that before it; 1 without one.
template <class B>
double roughIndex(const B& b) {
  if constexpr (std::is_same_v<B, RoughDielectric>) return b.eta;
  if constexpr (std::is_same_v<B, FurtherBsdf>)
    if (const auto* p = std::get_if<Principled>(&b.bsdf); p && p->refracts) return p->eta;
  return 1;
}

inline bool isCoat(const Bsdf& b, bool rough = false) {
  const auto* further = std::get_if<FurtherBsdf>(&b);
  return further && (std::holds_alternative<RoughCoat>(further->bsdf) ||
                     (!rough && std::holds_alternative<SmoothCoat>(further->bsdf)));
}
// Its table of transmittances is a spline, whose third derivative jumps at its knots.
inline bool hasSpline(const Bsdf& b) {
  return std::holds_alternative<RoughPlastic>(b) || isCoat(b, true);
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
      {"roughplastic of version 3 ggx 0.4",
       roughPlastic(facets(kGgx, 0.4f), {0.9f, 0.3f, 0.1f}, 1.5f, true, true)},
      {"roughplastic of version 3 beckmann 0.02",
       roughPlastic(facets(kBeckmann, 0.02f), Rgbf(1), 1.49f, false, true)},
      {"roughconductor phong 0.3", roughConductor(facets(kPhong, 0.3f), gold())},
      {"roughconductor phong 0.05", roughConductor(facets(kPhong, 0.05f), gold())},
      {"roughdielectric phong 0.25", roughDielectric(facets(kPhong, 0.25f), 1.5f), true},
      {"roughplastic phong 0.2",
       roughPlastic(facets(kPhong, 0.2f), {0.6f, 0.3f, 0.1f}, 1.5f, true)},
      {"roughconductor ggx textured",
       textured(roughConductor(facets(kGgx, 0.2f), gold()), 0.15f, 0.45f)},
      {"roughconductor beckmann textured",
       textured(roughConductor(facets(kBeckmann, 0.2f), gold()), 0.15f, 0.45f)},
      {"roughconductor phong textured",
       textured(roughConductor(facets(kPhong, 0.2f), gold()), 0.15f, 0.45f)},
      {"roughdielectric ggx textured",
       textured(roughDielectric(facets(kGgx, 0.2f), 1.5f), 0.15f, 0.45f), true},
      {"difftrans", diffuseTransmitter({0.6f, 0.5f, 0.2f}), true},
      {"roughdiffuse", roughDiffuse({0.2f, 0.5f, 0.8f}, 0.35f, false)},
      {"roughdiffuse fast", roughDiffuse({0.2f, 0.5f, 0.8f}, 0.35f, true)},
      {"ward balanced", ward(WardVariant::kBalanced, 0.1f, 0.3f, 0.4f, 0.4f)},
      {"ward", ward(WardVariant::kWard, 0.3f, 0.15f, 0.5f, 0.2f)},
      {"ward-duer", ward(WardVariant::kDuer, 0.2f, 0.2f, 0.5f, 0.1f)},
      {"coating of diffuse", coating(1.6f, diffuse({0.2f, 0.5f, 0.8f}), {0.1f, 0.5f, 1.2f})},
      {"coating of metal", coating(1.5f, roughConductor(facets(kGgx, 0.3f), gold()))},
      {"coating of plastic", coating(1.4f, plastic({0.6f, 0.3f, 0.1f}, 1.5f, false), Rgbf(0.3f))},
      {"coating of phong", coating(1.3f, phong(0.3f, 0.5f, 20), {0.1f, 0.2f, 0.4f})},
      {"coating of a lower index", coating(1 / 1.5f, phong(0.5f, 0.3f, 5), Rgbf(0.2f))},
      {"roughcoating of diffuse",
       roughCoating(facets(kGgx, 0.1f), 1.5f, diffuse({0.2f, 0.5f, 0.8f}), {0.6f, 0.2f, 0.1f})},
      {"roughcoating of ward", roughCoating(facets(kBeckmann, 0.3f), 1.5f,
                                            ward(WardVariant::kBalanced, 0.3f, 0.4f, 0.4f, 0.4f))},
      {"roughcoating of a mirror", roughCoating(facets(kPhong, 0.2f), 1.5f, conductor(gold()))},
      {"principled cloth", FurtherBsdf{principled({0.4f, 0.2f, 0.1f}, kPrincipledCloth)}},
      {"principled lacquer", FurtherBsdf{principled({0.3f, 0.1f, 0.2f}, kPrincipledLacquer)}},
      {"principled metal", FurtherBsdf{principled({0.9f, 0.6f, 0.3f}, kPrincipledMetal)}},
      {"principled glass", FurtherBsdf{principled({0.9f, 0.8f, 0.7f}, kPrincipledGlass)}, true},
      {"principled of all", FurtherBsdf{principled({0.3f, 0.2f, 0.5f}, kPrincipledAll, 1.4f)},
       true},
      {"principled inverted", FurtherBsdf{principled({0.2f, 0.3f, 0.2f}, kPrincipledAll, 1 / 1.5f)},
       true},
      {"principled textured",
       FurtherBsdf{textured(principled({0.3f, 0.2f, 0.5f}, kPrincipledAll, 1.4f), kPrincipledAll)},
       true},
      {"coating of principled",
       coating(1.5f, FurtherBsdf{principled({0.3f, 0.1f, 0.2f}, kPrincipledLacquer)})},
  };
  return cases;
}

inline Vec3f direction(float cosine, float azimuth) {
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace h2mc::test
