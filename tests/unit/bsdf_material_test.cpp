// SPDX-License-Identifier: MIT
// Materials: sides, opacity, and the plugins that make BSDFs.
#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "bsdf_properties.h"
#include "render/bsdf/material.h"
#include "render/bsdf/refractive_index.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

using namespace test;

const Vec2f kUv(0.3f, 0.4f);

TEST(BsdfMaterial, TwosidedFlipsBothDirections) {
  const std::vector<Bsdf> bsdfs = {phong(0.3f, 0.4f, 20), diffuse({0.1f, 0.2f, 0.3f})};
  const Material same = material(0, 0, true), two = material(0, 1, true), one = material(0);
  const Vec3f wi = direction(0.6f, 1), wo = direction(0.5f, 3.5f);
  const auto front = evaluateMaterial<float>(bsdfs, same, kUv, wi, wo);
  const auto back = evaluateMaterial<float>(bsdfs, same, kUv, flipped(wi), flipped(wo));
  EXPECT_GT(front.pdf, 0);
  EXPECT_EQ(front.value, back.value);
  EXPECT_EQ(front.pdf, back.pdf);
  EXPECT_EQ(evaluateMaterial<float>(bsdfs, one, kUv, flipped(wi), flipped(wo)).pdf, 0);
  EXPECT_EQ(evaluateMaterial<float>(bsdfs, same, kUv, wi, flipped(wo)).pdf, 0);
  EXPECT_NEAR(evaluateMaterial<float>(bsdfs, two, kUv, flipped(wi), flipped(wo)).value.y,
              0.2f * wo.z / kPi, 1e-6);
  EXPECT_FALSE(transmits(bsdfs, same));

  const LobeId lobe = chooseLobe(bsdfs, same, kUv, flipped(wi), 0.3f, 0.4f, 0.1f);
  EXPECT_TRUE(lobe.back);
  const Vec3f sampled = sampleMaterial<float>(bsdfs, same, kUv, flipped(wi), lobe, 0.3f, 0.4f);
  const LobeId frontLobe = chooseLobe(bsdfs, same, kUv, wi, 0.3f, 0.4f, 0.1f);
  EXPECT_EQ(flipped(sampled), sampleMaterial<float>(bsdfs, same, kUv, wi, frontLobe, 0.3f, 0.4f));
  Vec2f u;
  ASSERT_TRUE(invertLobe(bsdfs, same, kUv, flipped(wi), sampled, lobe, u));
  EXPECT_NEAR(u.x, 0.3f, 1e-5);
  EXPECT_NEAR(u.y, 0.4f, 1e-5);
  EXPECT_GT(lobePdf<float>(bsdfs, same, kUv, flipped(wi), sampled, lobe), 0);
  EXPECT_EQ(lobePdf<float>(bsdfs, same, kUv, flipped(wi), sampled, frontLobe), 0);
}

TEST(BsdfMaterial, OpacityAddsALobeThatPassesOn) {
  const std::vector<Bsdf> bsdfs = {diffuse(Rgbf(0.5f)), dielectric(1.5f)};
  const Material m = material(0, -1, false, constantTexture(Rgbf(0.25f, 0.5f, 0.75f)));
  const float p = luminance(Rgbf(0.25f, 0.5f, 0.75f));
  const Vec3f wi = direction(0.6f, 1), wo = direction(0.5f, 3.5f);
  const auto opaque = evaluateMaterial<float>(bsdfs, material(0), kUv, wi, wo);
  const auto e = evaluateMaterial<float>(bsdfs, m, kUv, wi, wo);
  EXPECT_FLOAT_EQ(e.value.x, 0.25f * opaque.value.x);
  EXPECT_FLOAT_EQ(e.value.z, 0.75f * opaque.value.z);
  EXPECT_FLOAT_EQ(e.pdf, p * opaque.pdf);
  EXPECT_FLOAT_EQ(e.pdfReverse, p * opaque.pdfReverse);
  EXPECT_TRUE(transmits(bsdfs, m));

  EXPECT_FALSE(chooseLobe(bsdfs, m, kUv, wi, 0, 0, p - 1e-4f).null);
  for (const Vec3f& w : {wi, flipped(wi)}) {
    const LobeId lobe = chooseLobe(bsdfs, m, kUv, w, 0, 0, p + 1e-4f);
    ASSERT_TRUE(lobe.null);
    EXPECT_TRUE(isDelta(bsdfs, m, lobe));
    const auto d = sampleDelta<float>(bsdfs, m, kUv, w, lobe);
    EXPECT_EQ(d.wo, -w);
    EXPECT_FLOAT_EQ(d.radiance.x * d.probability, 0.75f);
    EXPECT_EQ(d.radiance, d.importance);
    EXPECT_FLOAT_EQ(d.probability, 1 - p);
  }
  // Over a delta BSDF.
  const Material glass = material(1, -1, false, constantTexture(Rgbf(0.5f)));
  const auto whole = sampleDelta<float>(bsdfs, material(1), kUv, wi, LobeId{1});
  const auto half = sampleDelta<float>(bsdfs, glass, kUv, wi, LobeId{1});
  EXPECT_FLOAT_EQ(half.radiance.x, whole.radiance.x);
  EXPECT_FLOAT_EQ(half.probability, 0.5f * whole.probability);
  EXPECT_FALSE(hasNonDelta(bsdfs, glass));

  // White furnace: everything that arrives is reflected, absorbed by the base's 0.5, or passes.
  Random random(50, 1, 0);
  double sum = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const float u0 = random.uniform(), u1 = random.uniform();
    const LobeId lobe = chooseLobe(bsdfs, m, kUv, wi, u0, u1, random.uniform());
    if (lobe.null) {
      const auto d = sampleDelta<float>(bsdfs, m, kUv, wi, lobe);
      sum += d.radiance.y;
    } else {
      const Vec3f w = sampleMaterial<float>(bsdfs, m, kUv, wi, lobe, u0, u1);
      const auto b = evaluateMaterial<float>(bsdfs, m, kUv, wi, w);
      sum += b.value.y / b.pdf;
    }
  }
  EXPECT_NEAR(sum / n, 0.5 * 0.5 + 0.5, 0.01);
}

TEST(BsdfMaterial, NothingScattersWithoutABsdf) {
  const std::vector<Bsdf> none;
  const Material m = material(-1);
  const Vec3f wi = direction(0.6f, 1);
  const LobeId lobe = chooseLobe(none, m, kUv, wi, 0.1f, 0.2f, 0.3f);
  EXPECT_FALSE(isDelta(none, m, lobe));
  EXPECT_FALSE(hasNonDelta(none, m));
  const Vec3f wo = sampleMaterial<float>(none, m, kUv, wi, lobe, 0.1f, 0.2f);
  EXPECT_EQ(evaluateMaterial<float>(none, m, kUv, wi, wo).pdf, 0);
}

Bsdf make(const char* name, std::map<std::string, FakeProperties::Value> values = {}) {
  const BsdfPlugin& plugin = pluginNamed(bsdfPlugins(), name);
  return plugin.create(FakeProperties(plugin.parameters, std::move(values)));
}

TEST(BsdfPlugins, DefaultsAreMitsubas) {
  EXPECT_EQ(average(*std::get<Diffuse>(make("diffuse")).reflectance), Rgbf(0.5f));
  EXPECT_EQ(average(*std::get<Diffuse>(make("lambertian")).reflectance), Rgbf(0.5f));
  const auto p = std::get<Phong>(make("phong"));
  EXPECT_EQ(p.exponent, 30);
  EXPECT_EQ(average(*p.specular), Rgbf(0.2f));
  EXPECT_FLOAT_EQ(p.specularWeight, 0.2f / 0.7f);
  const auto metal = std::get<RoughConductor>(make("roughconductor"));
  EXPECT_EQ(metal.facets.distribution, kBeckmann);
  EXPECT_EQ(metal.facets.alpha, 0.1f);
  EXPECT_NEAR(metal.index.eta.x, 0.200438 / 1.000277, 1e-6);
  const auto glass = std::get<RoughDielectric>(make("roughdielectric"));
  EXPECT_FLOAT_EQ(glass.eta, 1.5046f / 1.000277f);
  EXPECT_FLOAT_EQ(std::get<Dielectric>(make("dielectric")).eta, 1.5046f / 1.000277f);
  EXPECT_FLOAT_EQ(std::get<Plastic>(make("plastic")).eta, 1.49f / 1.000277f);
  EXPECT_FLOAT_EQ(std::get<RoughPlastic>(make("roughplastic")).eta, 1.49f / 1.000277f);
  EXPECT_EQ(pluginNamed(bsdfPlugins(), "twosided").create, nullptr);
  EXPECT_EQ(pluginNamed(bsdfPlugins(), "mask").create, nullptr);
}

TEST(BsdfPlugins, ReadTheirParameters) {
  const auto mirror = std::get<Conductor>(make("conductor", {{"material", "none"}}));
  EXPECT_TRUE(mirror.index.mirror);
  const auto glass = std::get<RoughDielectric>(make("roughdielectric", {{"intIOR", "1.5"},
                                                                        {"extIOR", "Water"},
                                                                        {"distribution", "ggx"},
                                                                        {"alphaU", 0.3f},
                                                                        {"alphaV", 0.3f}}));
  EXPECT_FLOAT_EQ(glass.eta, 1.5f / 1.333f);
  EXPECT_EQ(glass.facets.distribution, kGgx);
  EXPECT_EQ(glass.facets.alpha, 0.3f);
  EXPECT_EQ(std::get<RoughConductor>(make("roughconductor", {{"alpha", 0.0f}})).facets.alpha,
            1e-4f);
  const auto metal =
      std::get<Conductor>(make("conductor", {{"eta", Rgbf(2)}, {"k", Rgbf(3)}, {"extEta", "1"}}));
  EXPECT_EQ(metal.index.eta, Rgbf(2));
  EXPECT_EQ(metal.index.k, Rgbf(3));

  // Reflectances above 1 are scaled to 0.99 in sum, unless one says not to.
  const auto bright = std::get<Phong>(
      make("phong", {{"diffuseReflectance", Rgbf(1, 0, 0)}, {"specularReflectance", Rgbf(1)}}));
  EXPECT_FLOAT_EQ(bright.scale, 0.99f / 2);
  const auto kept = std::get<Phong>(make("phong", {{"diffuseReflectance", Rgbf(1, 0, 0)},
                                                   {"specularReflectance", Rgbf(1)},
                                                   {"ensureEnergyConservation", false}}));
  EXPECT_EQ(kept.scale, 1);
}

TEST(BsdfPlugins, RefuseWhatTheyCannotDo) {
  EXPECT_THROW(make("roughconductor", {{"alphaU", 0.1f}, {"alphaV", 0.2f}}), SceneError);
  EXPECT_THROW(make("roughconductor", {{"alpha", 0.1f}, {"alphaV", 0.1f}}), SceneError);
  EXPECT_THROW(make("roughconductor", {{"alpha", -0.1f}}), SceneError);
  EXPECT_THROW(make("roughdielectric", {{"intIOR", "1.5"}, {"extIOR", "1.5"}}), SceneError);
  EXPECT_THROW(make("dielectric", {{"intIOR", "glas"}}), SceneError);
  EXPECT_THROW(make("dielectric", {{"intIOR", "-1"}}), SceneError);
  EXPECT_THROW(make("conductor", {{"material", "Unobtainium"}}), SceneError);
  try {
    make("conductor", {{"material", "Unobtainium"}});
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("Au"), std::string::npos);
  }
}

TEST(BsdfPlugins, KnowMaterialsByName) {
  for (const char* name : {"Au", "Ag", "Al", "Cu", "Cr", "W", "Ni", "Pt", "cu"})
    EXPECT_NE(conductorByName(name), nullptr) << name;
  EXPECT_FLOAT_EQ(*dielectricIndex("bk7"), 1.5046f);
  EXPECT_FLOAT_EQ(*dielectricIndex("BK7"), 1.5046f);
  EXPECT_FALSE(dielectricIndex("bk8"));
}

}  // namespace
}  // namespace h2mc
