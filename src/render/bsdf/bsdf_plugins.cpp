// SPDX-License-Identifier: MIT
// The table of BSDFs and how each is made from a scene's parameters. Names, defaults and meaning are
// Mitsuba 0.6's.
#include <fmt/format.h>

#include <charconv>
#include <numbers>

#include "render/bsdf/material.h"
#include "render/bsdf/principled_plugin.h"
#include "render/bsdf/refractive_index.h"
#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"

namespace h2mc {

namespace {

using enum ParameterType;

constexpr float kLargestRoughness = 100;
constexpr float kLargestFactor = 1000;  // of reflectances and transmittances

constexpr Parameter kConserve = {"ensureEnergyConservation", kBoolean, "true",
                                 "scale reflectances that exceed 1"};
constexpr Parameter kSpecular = {"specularReflectance", kTexture, "1", "factor of the reflection"};
constexpr Parameter kTransmittance = {"specularTransmittance", kTexture, "1",
                                      "factor of the transmission"};
constexpr Parameter kDistribution = {"distribution", kString, "beckmann", "of the facets' normals",
                                     "beckmann|ggx|phong"};
constexpr Parameter kAlpha = {"alpha", kNumber, "0.1",
                              "roughness, 0 to 100: the facets' root mean square slope"};
constexpr Parameter kTexturedAlpha = {"alpha", kTexture, "0.1",
                                      "roughness, 0 to 100: the facets' root mean square slope"};
constexpr Parameter kAlphaU = {"alphaU", kNumber, "0.1",
                               "roughness along u, 0 to 100, the same as along v"};
constexpr Parameter kAlphaV = {"alphaV", kNumber, "0.1",
                               "roughness along v, 0 to 100, the same as along u"};
constexpr Parameter kSampleVisible = {"sampleVisible",
                                      kBoolean,
                                      "true",
                                      "how other renderers sample; no effect on the image",
                                      "",
                                      "",
                                      true};
constexpr Parameter kExteriorIndex = {
    "extIOR", kString,  "air", "refractive index outside: a number from 0.01 to 100 or a name",
    "",       "ext_ior"};
constexpr Parameter kGlassIndex = {
    "intIOR", kString,  "bk7", "refractive index inside: a number from 0.01 to 100 or a name",
    "",       "int_ior"};
constexpr Parameter kPlasticIndex = {
    "intIOR",
    kString,
    "polypropylene",
    "refractive index of the coat: a number from 0.01 to 100 or a name",
    "",
    "int_ior"};
constexpr Parameter kMaterialName = {"material", kString, "Cu",
                                     "a metal's name, or none: reflects everything"};
constexpr bool kMayBeNegative = true;  // measured channels dip below zero
constexpr Parameter kEta = {"eta", kColor, "",    "refractive index; the material's by default",
                            "",    "",     false, kMayBeNegative};
constexpr Parameter kK = {"k", kColor, "",    "extinction coefficient; the material's by default",
                          "",  "",     false, kMayBeNegative};
constexpr Parameter kExteriorEta = {
    "extEta", kString, "air", "refractive index outside: a number from 0.01 to 100 or a name"};
constexpr Parameter kNonlinear = {"nonlinear", kBoolean, "false",
                                  "colour shifts by scattering inside the coat"};
constexpr Parameter kDiffuseReflectance = {"diffuseReflectance", kTexture, "0.5",
                                           "reflectance of the diffuse part"};

constexpr Parameter kDiffuseParameters[] = {
    {"reflectance", kTexture, "0.5", "diffuse reflectance", "", "diffuseReflectance"}, kConserve};
constexpr Parameter kPhongParameters[] = {
    kDiffuseReflectance,
    {"specularReflectance", kTexture, "0.2", "reflectance of the glossy part"},
    {"exponent", kNumber, "30", "of the cosine around the mirror direction, 0 to 1e8"},
    kConserve};
constexpr Parameter kConductorParameters[] = {kMaterialName, kEta,      kK,
                                              kExteriorEta,  kSpecular, kConserve};
constexpr Parameter kRoughConductorParameters[] = {
    kDistribution, kTexturedAlpha, kAlphaU,        kAlphaV,  kMaterialName, kEta, kK,
    kExteriorEta,  kSpecular,      kSampleVisible, kConserve};
constexpr Parameter kDielectricParameters[] = {kGlassIndex, kExteriorIndex, kSpecular,
                                               kTransmittance, kConserve};
constexpr Parameter kRoughDielectricParameters[] = {
    kDistribution,  kTexturedAlpha, kAlphaU,        kAlphaV,        kGlassIndex,
    kExteriorIndex, kSpecular,      kTransmittance, kSampleVisible, kConserve};
constexpr Parameter kPlasticParameters[] = {kPlasticIndex, kExteriorIndex, kDiffuseReflectance,
                                            kSpecular,     kNonlinear,     kConserve};
constexpr Parameter kRoughPlasticParameters[] = {
    kDistribution, kAlpha,     kPlasticIndex,  kExteriorIndex, kDiffuseReflectance,
    kSpecular,     kNonlinear, kSampleVisible, kConserve};
constexpr Parameter kMaskParameters[] = {
    {"opacity", kTexture, "0.5", "share of light that meets the nested BSDF; the rest goes on"},
    kConserve};

constexpr Parameter kThinDielectricParameters[] = {kGlassIndex, kExteriorIndex, kSpecular,
                                                   kTransmittance, kConserve};
constexpr Parameter kDiffuseTransmitterParameters[] = {
    {"transmittance", kTexture, "0.5", "diffuse transmittance"}, kConserve};
constexpr Parameter kRoughDiffuseParameters[] = {
    {"reflectance", kTexture, "0.5", "diffuse reflectance", "", "diffuseReflectance"},
    {"alpha", kNumber, "0.2",
     "roughness, 0 to 100: root 2 times the facets' standard deviation in radians"},
    {"useFastApprox", kBoolean, "false", "the approximation that the authors give"},
    kConserve};
constexpr Parameter kWardParameters[] = {
    {"variant", kString, "balanced", "how the lobe is normalised", "ward|ward-duer|balanced"},
    {"alphaU", kNumber, "0.1", "roughness along u, 0 to 100"},
    {"alphaV", kNumber, "0.1", "roughness along v, 0 to 100"},
    kDiffuseReflectance,
    {"specularReflectance", kTexture, "0.2", "reflectance of the glossy part"},
    kConserve};
constexpr Parameter kThickness = {"thickness", kNumber, "1",
                                  "of the layer, 0 to 10000: what sigmaA's unit of length is"};
constexpr Parameter kSigmaA = {"sigmaA", kTexture, "0",
                               "absorption in the layer per unit of length"};
constexpr Parameter kCoatIndex = {
    "intIOR", kString,  "bk7", "refractive index of the layer: a number from 0.01 to 100 or a name",
    "",       "int_ior"};
constexpr Parameter kCoatingParameters[] = {kCoatIndex, kExteriorIndex, kThickness,
                                            kSigmaA,    kSpecular,      kConserve};
constexpr Parameter kRoughCoatingParameters[] = {kDistribution,  kAlpha,         kCoatIndex,
                                                 kExteriorIndex, kThickness,     kSigmaA,
                                                 kSpecular,      kSampleVisible, kConserve};
constexpr Parameter kBumpParameters[] = {
    {"texture", kTexture, "", "the height, by its luminance, in the scene's units", "", "", false,
     true, true},
    {"scale", kNumber, "1", "factor of the height"}};
constexpr Parameter kNormalParameters[] = {
    {"texture", kTexture, "", "the normals as 2 rgb - 1: along dp/du, across it, outwards", "",
     "normalmap", false, false, true}};
constexpr Parameter kBlendParameters[] = {
    {"weight", kTexture, "0.5", "share of the second bsdf; the first has the rest"}};
constexpr Parameter kMixtureParameters[] = {
    {"weights", kString, "", "one a bsdf; what a sum below 1 lacks is black"}, kConserve};

float largest(const Rgbf& c) { return std::max({c.x, c.y, c.z}); }

// By how much Mitsuba scales reflectances whose sum may exceed 1. `name`: of the parameter that they are.
float energyScale(const Properties& p, std::string_view name, const Rgbf& highest) {
  constexpr float kMost = 0.99f;
  if (!(largest(highest) > 1 && p.boolean("ensureEnergyConservation"))) return 1;
  const float scale = kMost / largest(highest);
  noteChange(p, name, fmt::format("up to {:g}", largest(highest)),
             fmt::format("times {:g}, to conserve energy", scale));
  return scale;
}

float refractiveIndex(const Properties& p, std::string_view name) {
  const std::string text = p.string(name);
  const char* const end = text.data() + text.size();
  float number = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && stop == end) {
    constexpr float kLowest = 0.01f, kHighest = 100;
    if (!(number >= kLowest && number <= kHighest))
      p.fail(name,
             fmt::format("\"{}\" is {:g}, expected a refractive index from {:g} to {:g}, or a name",
                         name, number, kLowest, kHighest));
    return number;
  }
  const auto index = dielectricIndex(text);
  if (!index)
    p.fail(name, "no refractive index is known for \"" + text + "\"; there are " +
                     dielectricNames() + ", or give a number");
  return *index;
}

// The inside's refractive index over the outside's.
float relativeIndex(const Properties& p, bool mustDiffer) {
  const float inside = refractiveIndex(p, "intIOR"), outside = refractiveIndex(p, "extIOR");
  if (mustDiffer && inside == outside)
    p.fail("intIOR", "the refractive indices inside and outside must differ");
  return inside / outside;
}

float atLeastSmallest(const Properties& p, std::string_view name, float alpha) {
  if (alpha >= kSmallestRoughness) return alpha;
  noteChange(p, name, fmt::format("{:g}", alpha), fmt::format("{:g}", kSmallestRoughness));
  return kSmallestRoughness;
}

float roughness(const Properties& p, std::string_view name) {
  return atLeastSmallest(p, name, numberIn(p, name, 0, kLargestRoughness));
}

FacetDistribution readDistribution(const Properties& p) {
  const std::string name = p.string("distribution");
  if (name == "ggx") return FacetDistribution::kGgx;
  return name == "phong" ? FacetDistribution::kPhong : FacetDistribution::kBeckmann;
}

void readFacets(const Properties& p, FacetSurface& b) {
  b.facets.distribution = readDistribution(p);
  if (p.given("alphaU") || p.given("alphaV")) {
    if (p.given("alpha")) p.fail("alpha", "give either alpha, or alphaU and alphaV");
    b.facets.alpha = roughness(p, "alphaU");
    if (b.facets.alpha != roughness(p, "alphaV"))
      p.fail("alphaV", "anisotropic roughness is not supported: alphaU and alphaV must be equal");
    return;
  }
  const TexturePtr alpha = textureUpTo(p, "alpha", kLargestRoughness);
  const Rgbf mean = average(*alpha);
  // One number is to stay the same number.
  const float value = mean.x == mean.y && mean.x == mean.z ? mean.x : scalarOf(mean);
  if (value < 0) p.fail("alpha", "a roughness must not be negative");
  b.facets.alpha = atLeastSmallest(p, "alpha", value);
  if (!std::holds_alternative<ConstantTexture>(*alpha)) b.roughness = alpha;
}

// Of a metal's index: its absolute value, since reflectance depends on the squares alone.
Rgbf conductorColor(const Properties& p, std::string_view name) {
  constexpr float kHighest = 1e4f;
  const Rgbf given = p.color(name), color = glm::abs(given);
  if (given != color) noteChange(p, name, colorText(given), "its absolute value");
  if (!(largest(color) <= kHighest))
    p.fail(name, fmt::format("\"{}\" is up to {:g}, expected values from {:g} to {:g}", name,
                             largest(color), -kHighest, kHighest));
  return color;
}

ConductorIndex readConductor(const Properties& p) {
  Rgbf eta(0), k(1);
  const std::string name = p.string("material");
  if (const NamedConductor* metal = conductorByName(name)) {
    eta = {metal->eta[0], metal->eta[1], metal->eta[2]};
    k = {metal->k[0], metal->k[1], metal->k[2]};
  } else if (name != "none" && name != "None") {
    p.fail("material", "unknown material \"" + name + "\"; there are " + conductorNames());
  }
  if (p.given("eta")) eta = conductorColor(p, "eta");
  if (p.given("k")) k = conductorColor(p, "k");
  const float outside = refractiveIndex(p, "extEta");
  return {eta / outside, k / outside, eta == Rgbf(0)};
}

// Reflectances with their scale and the probability of the specular lobe.
float specularWeight(const Rgbf& specular, const Rgbf& diffuse) {
  const float s = luminance(specular), d = luminance(diffuse);
  return s > 0 ? s / (s + d) : 0;
}

Bsdf createDiffuse(const Properties& p) {
  Diffuse b;
  b.reflectance = textureUpTo(p, "reflectance", kLargestFactor);
  b.scale = energyScale(p, "reflectance", maximum(*b.reflectance));
  return b;
}

Bsdf createPhong(const Properties& p) {
  Phong b;
  b.diffuse = textureUpTo(p, "diffuseReflectance", kLargestFactor);
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.exponent = numberIn(p, "exponent", 0, 1e8f);
  b.scale = energyScale(p, "diffuseReflectance", maximum(*b.diffuse) + maximum(*b.specular));
  b.specularWeight = specularWeight(average(*b.specular), average(*b.diffuse));
  return b;
}

Bsdf createConductor(const Properties& p) {
  Conductor b;
  b.index = readConductor(p);
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.scale = energyScale(p, "specularReflectance", maximum(*b.specular));
  return b;
}

Bsdf createRoughConductor(const Properties& p) {
  RoughConductor b;
  readFacets(p, b);
  b.index = readConductor(p);
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.scale = energyScale(p, "specularReflectance", maximum(*b.specular));
  return b;
}

template <class B>
void readInterface(const Properties& p, B& b) {
  b.specularReflectance = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.specularTransmittance = textureUpTo(p, "specularTransmittance", kLargestFactor);
  b.reflectanceScale = energyScale(p, "specularReflectance", maximum(*b.specularReflectance));
  b.transmittanceScale = energyScale(p, "specularTransmittance", maximum(*b.specularTransmittance));
}

Bsdf createDielectric(const Properties& p) {
  Dielectric b;
  b.eta = relativeIndex(p, false);
  readInterface(p, b);
  return b;
}

Bsdf createRoughDielectric(const Properties& p) {
  RoughDielectric b;
  readFacets(p, b);
  b.eta = relativeIndex(p, true);
  readInterface(p, b);
  return b;
}

template <class B>
void readCoat(const Properties& p, B& b, double internalReflectance) {
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.specularScale = energyScale(p, "specularReflectance", maximum(*b.specular));
  const TexturePtr diffuse = textureUpTo(p, "diffuseReflectance", kLargestFactor);
  const float scale = energyScale(p, "diffuseReflectance", maximum(*diffuse));
  b.specularWeight =
      specularWeight(average(*b.specular) * b.specularScale, average(*diffuse) * scale);
  b.base = LayeredDiffuse(diffuse, scale, internalReflectance, b.eta, p.boolean("nonlinear"));
}

Bsdf createPlastic(const Properties& p) {
  Plastic b;
  b.eta = relativeIndex(p, false);
  readCoat(p, b, fresnelDiffuse(1.0 / b.eta));
  return b;
}

Bsdf createRoughPlastic(const Properties& p) {
  RoughPlastic b;
  b.facets = {readDistribution(p), roughness(p, "alpha")};
  b.eta = relativeIndex(p, true);
  b.transmittance = RoughTransmittance::shared(b.facets, b.eta);
  readCoat(p, b,
           p.isOldVersion() ? b.transmittance->internalReflectance()
                            : RoughTransmittance::facetsInternalReflectance(b.facets, b.eta));
  return b;
}

Bsdf createThinDielectric(const Properties& p) {
  ThinDielectric b;
  b.eta = relativeIndex(p, false);
  readInterface(p, b);
  return FurtherBsdf{b};
}

Bsdf createDiffuseTransmitter(const Properties& p) {
  DiffuseTransmitter b;
  b.transmittance = textureUpTo(p, "transmittance", kLargestFactor);
  b.scale = energyScale(p, "transmittance", maximum(*b.transmittance));
  return FurtherBsdf{b};
}

Bsdf createRoughDiffuse(const Properties& p) {
  RoughDiffuse b;
  b.reflectance = textureUpTo(p, "reflectance", kLargestFactor);
  b.scale = energyScale(p, "reflectance", maximum(*b.reflectance));
  b.sigma = numberIn(p, "alpha", 0, kLargestRoughness) * std::numbers::sqrt2_v<float> / 2;
  b.fast = p.boolean("useFastApprox");
  return FurtherBsdf{b};
}

Bsdf createWard(const Properties& p) {
  Ward b;
  const std::string variant = p.string("variant");
  if (variant == "ward") b.variant = WardVariant::kWard;
  if (variant == "ward-duer") b.variant = WardVariant::kDuer;
  b.alphaU = roughness(p, "alphaU");
  b.alphaV = roughness(p, "alphaV");
  b.diffuse = textureUpTo(p, "diffuseReflectance", kLargestFactor);
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.scale = energyScale(p, "diffuseReflectance", maximum(*b.diffuse) + maximum(*b.specular));
  b.specularWeight = specularWeight(average(*b.specular), average(*b.diffuse));
  return FurtherBsdf{b};
}

template <class Interface>
Bsdf createCoat(const Properties& p, const Bsdf& below, Interface interface) {
  constexpr float kThickest = 1e4f, kDarkest = 1e4f;
  Coat<Interface> b;
  b.interface = std::move(interface);
  b.below = std::make_shared<const CoatedBsdf>(below);
  b.thickness = numberIn(p, "thickness", 0, kThickest);
  const TexturePtr sigma = textureUpTo(p, "sigmaA", kDarkest);
  if (largest(maximum(*sigma)) * b.thickness > 0) b.absorption = sigma;
  b.specular = textureUpTo(p, "specularReflectance", kLargestFactor);
  b.specularScale = energyScale(p, "specularReflectance", maximum(*b.specular));
  // Both lobes are drawn if there are both: what is below may be brighter somewhere than its means say.
  const Rgbf left = glm::exp(average(*sigma) * (-2 * b.thickness));
  const Rgbf base = std::visit([](const auto& inner) { return inner.albedo(); }, below);
  const float share = specularWeight(average(*b.specular) * b.specularScale, base * left);
  b.specularWeight = share > 0 ? std::clamp(share, 0.05f, 0.95f) : 0;
  return FurtherBsdf{b};
}

Bsdf createCoating(const Properties& p, const Bsdf& below) {
  return createCoat(p, below, SmoothInterface{relativeIndex(p, true)});
}

Bsdf createRoughCoating(const Properties& p, const Bsdf& below) {
  RoughInterface rough;
  rough.facets = {readDistribution(p), roughness(p, "alpha")};
  rough.eta = relativeIndex(p, true);
  rough.transmittance = RoughTransmittance::shared(rough.facets, rough.eta);
  return createCoat(p, below, std::move(rough));
}

constexpr int kMostMixed = kDeepestBlend + 1;

constexpr BsdfPlugin kPlugins[] = {
    {"diffuse", "Lambertian reflection", kDiffuseParameters, createDiffuse},
    {"lambertian", "Another name of diffuse", kDiffuseParameters, createDiffuse},
    {"phong", "Modified Phong: a diffuse and a cosine-power lobe", kPhongParameters, createPhong},
    {"conductor", "Smooth metal", kConductorParameters, createConductor},
    {"roughconductor", "Rough metal of GGX, Beckmann or Phong facets", kRoughConductorParameters,
     createRoughConductor},
    {"dielectric", "Smooth glass or water", kDielectricParameters, createDielectric},
    {"roughdielectric", "Rough glass of GGX, Beckmann or Phong facets", kRoughDielectricParameters,
     createRoughDielectric},
    {"plastic", "Diffuse under a smooth coat", kPlasticParameters, createPlastic},
    {"roughplastic", "Diffuse under a rough coat", kRoughPlasticParameters, createRoughPlastic},
    {"thindielectric", "A thin pane of smooth glass, which bends nothing",
     kThinDielectricParameters, createThinDielectric},
    {"difftrans", "Diffuse transmission: paper, leaves", kDiffuseTransmitterParameters,
     createDiffuseTransmitter},
    {"roughdiffuse", "Rough diffuse reflection [Oren and Nayar 1994]", kRoughDiffuseParameters,
     createRoughDiffuse},
    {"ward", "Anisotropic gloss over a diffuse base [Ward 1992]", kWardParameters, createWard},
    {"principled", "Burley's BSDF of metals, plastics, glass and cloth, as in Mitsuba 3",
     kPrincipledParameters, createPrincipled},
    {"null", "Nothing: light goes straight on", {}, nullptr},
    {"coating", "A smooth dielectric layer over the nested BSDF [Weidlich and Wilkie 2007]",
     kCoatingParameters, nullptr, 1, createCoating},
    {"roughcoating", "The same with a rough surface", kRoughCoatingParameters, nullptr, 1,
     createRoughCoating},
    {"twosided", "The nested BSDF on both sides, or one each for front and back", {}, nullptr, 2},
    {"mask", "The nested BSDF with holes", kMaskParameters, nullptr, 1},
    {"bumpmap", "The nested BSDF on a surface with a height", kBumpParameters, nullptr, 1},
    {"normalmap", "The nested BSDF with other normals", kNormalParameters, nullptr, 1},
    {"blendbsdf", "Two nested BSDFs, the share of each by a texture", kBlendParameters, nullptr, 2},
    {"mixturebsdf", "Nested BSDFs with a weight each", kMixtureParameters, nullptr, kMostMixed},
};

}  // namespace

std::span<const BsdfPlugin> bsdfPlugins() { return kPlugins; }

}  // namespace h2mc
