// SPDX-License-Identifier: MIT
// The principled BSDF against its formulas, written down as Burley and Mitsuba 3 have them, and how scenes give it.
#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "render/core/random.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using namespace test;
using Vec = glm::dvec3;

double fifth(double x) { return std::pow(std::clamp(x, 0.0, 1.0), 5); }

// Of unpolarised light, by the amplitudes; c: signed cosine with the normal towards the outside.
double fresnel(double c, double eta) {
  const double relative = c >= 0 ? eta : 1 / eta, ci = std::abs(c);
  const double ct2 = 1 - (1 - ci * ci) / (relative * relative);
  if (ct2 <= 0) return 1;
  const double ct = std::sqrt(ct2);
  const double s = (ci - relative * ct) / (ci + relative * ct);
  const double p = (relative * ci - ct) / (relative * ci + ct);
  return (s * s + p * p) / 2;
}
// Towards 1 from `normal` at right angles, by the cosine on the thinner side.
double schlick(double normal, double c, double eta) {
  const double ct = std::sqrt(std::max(0.0, 1 - (1 - c * c) / (eta * eta)));
  const double w = fifth(1 - (eta > 1 ? c : ct));
  return normal + (1 - normal) * w;
}
// Smith's masking of a GGX surface, by the tangent along the direction's azimuth.
double masking(const Vec& w, double ax, double ay) {
  const double tan2 = (w.x * w.x * ax * ax + w.y * w.y * ay * ay) / (w.z * w.z);
  return 2 / (1 + std::sqrt(1 + tan2));
}

// f(wi, wo) |cos(wo)|, channel by channel.
double formula(const Principled& b, const Vec& wi, const Vec& wo, int channel) {
  const PrincipledValues<double> v(b.means);
  const double color = v.color[channel], eta = b.eta;
  const double y = luminance(v.color), tint = color / y;
  const double aspect = std::sqrt(1 - 0.9 * v.anisotropic), rough = v.roughness * v.roughness;
  const double ax = std::max(0.001, rough / aspect), ay = std::max(0.001, rough * aspect);
  const double base = (1 - v.metallic) * (1 - v.specTrans), glass = (1 - v.metallic) * v.specTrans;
  const bool front = wi.z > 0, reflects = wi.z * wo.z > 0;
  const double path = front ? eta : 1 / eta;
  Vec h = glm::normalize(wi + wo * (reflects ? 1 : path));
  if (h.z < 0) h = -h;
  const double ih = glm::dot(wi, h), oh = glm::dot(wo, h);
  const double slopes = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
  const double d = 1 / (std::numbers::pi * ax * ay * slopes * slopes);
  const double g = masking(wi, ax, ay) * masking(wo, ax, ay);
  const double f = fresnel(ih, eta);
  if (!reflects) {
    if (!b.refracts || ih * (front ? 1 : -1) <= 0 || oh * (front ? 1 : -1) >= 0) return 0;
    return std::sqrt(color) * glass *
           std::abs((1 - f) * d * g * ih * oh / (wi.z * std::pow(ih + path * oh, 2)));
  }
  if (!front) return b.refracts ? glass * f * d * g / (4 * std::abs(wi.z)) : 0;
  const double normal = std::pow((eta - 1) / (eta + 1), 2);
  const double spec = (1 - v.metallic) * (1 - v.specTint) * f +
                      v.metallic * schlick(color, ih, eta) +
                      (1 - v.metallic) * v.specTint * schlick(tint * normal, ih, eta);
  double sum = spec * d * g / (4 * wi.z);
  // The clear coat.
  const double a2 = std::pow(0.1 + v.clearcoatGloss * (0.001 - 0.1), 2);
  const double coat = (a2 - 1) / (std::numbers::pi * std::log(a2) * (1 + (a2 - 1) * h.z * h.z));
  sum += 0.25 * v.clearcoat * schlick(0.04, ih, eta) * coat * masking(wi, 0.25, 0.25) *
         masking(wo, 0.25, 0.25) * wo.z;
  // Base and sheen.
  const double fo = fifth(1 - wo.z), fi = fifth(1 - wi.z), retro = 2 * v.roughness * oh * oh;
  const double burley = (1 - fi / 2) * (1 - fo / 2) + retro * (fo + fi + fo * fi * (retro - 1));
  const double edge = (1 + fo * (retro / 2 - 1)) * (1 + fi * (retro / 2 - 1));
  const double flat = 1.25 * (edge * (1 / (wo.z + wi.z) - 0.5) + 0.5);
  sum += base * wo.z * color / std::numbers::pi * (burley + v.flatness * (flat - burley));
  return sum + v.sheen * (1 - v.metallic) * fifth(1 - oh) * (1 + v.sheenTint * (tint - 1)) * wo.z;
}

TEST(Principled, IsItsFormula) {
  Random random(50, 1, 0);
  int refracted = 0;
  for (int k = 0; k < 4000; ++k) {
    float numbers[Principled::kNumbers];
    for (float& x : numbers) x = random.uniform();
    if (k % 2) numbers[3] = 0;
    const float eta = k % 4 < 3 ? 1.05f + random.uniform() : 1 / 1.4f;
    const Principled b = principled({0.1f + random.uniform(), 0.4f, 0.7f}, numbers, eta);
    const auto drawn = [&] {
      const float z = 0.02f + 0.97f * random.uniform();
      return glm::normalize(
          Vec(direction(random.uniform() < 0.4f ? -z : z, 6.28f * random.uniform())));
    };
    const Vec wi = drawn(), wo = drawn();
    const auto e = b.evaluate<double>(Vec2<double>(0, 0), wi, wo);
    refracted += wi.z * wo.z < 0 && e.value.x > 0;
    for (int channel = 0; channel < 3; ++channel) {
      const double expected = formula(b, wi, wo, channel);
      EXPECT_NEAR(e.value[channel], expected, 1e-6 * (1e-6 + expected)) << wi.z << " " << wo.z;
    }
  }
  EXPECT_GT(refracted, 100);
}

// Straight on: what can be reckoned by hand.
TEST(Principled, ReflectsStraightOnWhatItShould) {
  const Vec3<double> up(0, 0, 1);
  const auto at = [&](std::initializer_list<std::pair<int, float>> set) {
    float numbers[Principled::kNumbers] = {1};
    for (const auto& [i, x] : set) numbers[i] = x;
    const Principled b = principled({0.5f, 0.25f, 0.125f}, numbers, 1.5f);
    return b.evaluate<double>(Vec2<double>(0, 0), up, up).value;
  };
  const double inversePi = std::numbers::inv_pi;
  // Roughness 1: D = 1 / pi. The index 1.5 reflects 0.04.
  EXPECT_NEAR(at({}).x, (0.5 + 0.04 / 4) * inversePi, 1e-7);
  // A metal's colour.
  EXPECT_NEAR(at({{2, 1.f}}).y, 0.25 / 4 * inversePi, 1e-7);
  // Half the roughness, a sixteenth of alpha squared: D is 16 times as high.
  EXPECT_NEAR(at({{0, 0.5f}, {2, 1.f}}).y, 0.25 * 16 / 4 * inversePi, 1e-6);
  // With specTrans nothing diffuse is left.
  EXPECT_NEAR(at({{3, 1.f}}).x, 0.04 / 4 * inversePi, 1e-7);
  // The dullest coat: alpha 0.1, D = (1 - a^2) / (pi a^2 log(1 / a^2)).
  EXPECT_NEAR(at({{8, 1.f}}).x - at({}).x, 0.25 * 0.04 * 0.99 / (0.01 * std::log(100)) * inversePi,
              1e-6);
  // Sheen is at grazing angles alone.
  EXPECT_NEAR(at({{5, 1.f}}).x, at({}).x, 1e-12);
}

std::string sceneWith(const std::string& bsdf) {
  return R"(<scene version="3.0.0"><integrator type="path"/><sensor type="perspective"/>
<shape type="sphere">)" +
         bsdf + R"(</shape><emitter type="constant"/></scene>)";
}
const Principled& read(const Scene& scene) {
  return std::get<Principled>(std::get<FurtherBsdf>(scene.bsdfs.at(0)).bsdf);
}

TEST(Principled, ReadsWhatMitsuba3Writes) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(sceneWith(R"(<bsdf type="principled">
<rgb name="base_color" value="1.0, 0.5, 0.25"/><float name="metallic" value="0.7"/>
<float name="specular" value="0.6"/><float name="roughness" value="0.2"/><float name="spec_tint" value="0.4"/>
<float name="anisotropic" value="0.5"/><float name="sheen" value="0.3"/><float name="sheen_tint" value="0.2"/>
<float name="clearcoat" value="0.6"/><float name="clearcoat_gloss" value="0.3"/>
<float name="flatness" value="0.1"/><float name="spec_trans" value="0.4"/>
<float name="diffuse_reflectance_sampling_rate" value="2"/><float name="main_specular_sampling_rate" value="1"/>
<float name="clearcoat_sampling_rate" value="0.5"/></bsdf>)"));
  EXPECT_TRUE(scene.warnings.empty());
  const Principled& b = read(scene);
  const PrincipledValues<float>& v = b.means;
  EXPECT_EQ(v.color, Rgbf(1, 0.5f, 0.25f));
  EXPECT_FLOAT_EQ(v.roughness, 0.2f);
  EXPECT_FLOAT_EQ(v.anisotropic, 0.5f);
  EXPECT_FLOAT_EQ(v.metallic, 0.7f);
  EXPECT_FLOAT_EQ(v.specTrans, 0.4f);
  EXPECT_FLOAT_EQ(v.specTint, 0.4f);
  EXPECT_FLOAT_EQ(v.sheen, 0.3f);
  EXPECT_FLOAT_EQ(v.sheenTint, 0.2f);
  EXPECT_FLOAT_EQ(v.flatness, 0.1f);
  EXPECT_FLOAT_EQ(v.clearcoat, 0.6f);
  EXPECT_FLOAT_EQ(v.clearcoatGloss, 0.3f);
  EXPECT_FALSE(b.textures);
  EXPECT_TRUE(b.refracts && transmits(scene.bsdfs, scene.materials.at(0)));
  // Reflects 0.08 * 0.6 straight on.
  EXPECT_NEAR(std::pow((b.eta - 1) / (b.eta + 1), 2), 0.048, 1e-6);
  // Along dp/du.
  EXPECT_TRUE(scene.materials.at(0).frame);
}

TEST(Principled, HasMitsubasDefaults) {
  testing::SceneFolder folder;
  const Scene scene = folder.read(sceneWith(R"(<bsdf type="principled"/>)"));
  const Principled& b = read(scene);
  EXPECT_EQ(b.means.color, Rgbf(0.5f));
  EXPECT_EQ(b.means.roughness, 0.5f);
  EXPECT_NEAR(b.eta, 1.5f, 1e-6f);
  EXPECT_FALSE(b.refracts);
  EXPECT_FALSE(scene.materials.at(0).frame);
  for (const float other :
       {b.means.anisotropic, b.means.metallic, b.means.specTrans, b.means.specTint, b.means.sheen,
        b.means.sheenTint, b.means.flatness, b.means.clearcoat, b.means.clearcoatGloss})
    EXPECT_EQ(other, 0);
}

TEST(Principled, TakesTexturesForAll) {
  testing::SceneFolder folder;
  const Scene scene =
      folder.read(sceneWith(R"(<bsdf type="principled"><texture name="metallic" type="checkerboard">
<float name="color0" value="0"/><float name="color1" value="1"/></texture></bsdf>)"));
  const Principled& b = read(scene);
  ASSERT_TRUE(b.textures);
  EXPECT_NEAR(b.means.metallic, 0.5f, 1e-6f);
  const Vec3f up(0, 0, 1);
  // A metal's BRDF on one field, the base's on the next.
  const float dark = b.evaluate<float>(Vec2f(0.2f, 0.2f), up, up).value.x;
  const float light = b.evaluate<float>(Vec2f(0.7f, 0.2f), up, up).value.x;
  EXPECT_GT(std::abs(dark - light), 0.1f);
}

TEST(Principled, SaysWhatIsWrong) {
  testing::SceneFolder folder;
  const auto error = [&](const std::string& inside) {
    return folder.error(sceneWith("<bsdf type=\"principled\">" + inside + "</bsdf>"));
  };
  EXPECT_NE(error(R"(<float name="eta" value="1.5"/><float name="specular" value="0.5"/>)")
                .find("give either eta or specular"),
            std::string::npos);
  EXPECT_NE(error(R"(<float name="specular" value="2"/>)").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(error(R"(<float name="eta" value="0"/>)").find("from 0.01 to 100"), std::string::npos);
  // Beyond their range numbers are held to it, and the scene says so.
  const Scene scene = folder.read(
      sceneWith(R"(<bsdf type="principled"><float name="roughness" value="1.5"/></bsdf>)"));
  EXPECT_EQ(read(scene).means.roughness, 1);
  EXPECT_EQ(std::count_if(scene.notes.begin(), scene.notes.end(),
                          [](const std::string& note) {
                            return note.find("\"roughness\"") != std::string::npos;
                          }),
            1);
}

// An index of 1 refracts nothing: as Mitsuba 3 has it, the smallest that does.
TEST(Principled, WhatRefractsHasAnIndex) {
  testing::SceneFolder folder;
  const auto eta = [&](const std::string& inside) {
    return read(folder.read(sceneWith("<bsdf type=\"principled\">" + inside + "</bsdf>"))).eta;
  };
  const std::string glass = R"(<float name="spec_trans" value="1"/>)";
  EXPECT_EQ(eta(R"(<float name="eta" value="1"/>)"), 1);
  EXPECT_EQ(eta(glass + R"(<float name="eta" value="1"/>)"), 1.001f);
  EXPECT_NEAR(eta(glass + R"(<float name="specular" value="0"/>)"), 1.018f, 1e-3f);
}

}  // namespace
}  // namespace h2mc
