// SPDX-License-Identifier: MIT
// Blends: what is drawn against the density, the choice of lobes, and what is reflected in all.
#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "chi_square.h"
#include "render/bsdf/lobe_choice.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

using namespace test;

const Vec2f kUv(0.3f, 0.4f);

struct MaterialCase {
  std::string name;
  Material material;
  bool transmits = false;
};

Material blended(Material first, Material second, TexturePtr weight, float scale = 1) {
  Material m;
  m.blend = std::make_shared<const Blend>(Blend{std::make_shared<const Material>(std::move(first)),
                                                std::make_shared<const Material>(std::move(second)),
                                                std::move(weight), scale});
  return m;
}

const std::vector<Bsdf>& bsdfs() {
  static const std::vector<Bsdf> list = {
      diffuse({0.2f, 0.5f, 0.8f}),
      roughConductor(facets(kGgx, 0.3f), gold()),
      plastic({0.6f, 0.3f, 0.1f}, 1.5f, false),
      roughDielectric(facets(kGgx, 0.3f), 1.5f),
      conductor(gold()),
      coating(1.5f, plastic({0.6f, 0.3f, 0.1f}, 1.4f, false), Rgbf(0.2f)),
      roughCoating(facets(kGgx, 0.2f), 1.5f, phong(0.3f, 0.5f, 20))};
  return list;
}

std::vector<MaterialCase> materialCases() {
  const TexturePtr quarter = gray(0.25f);
  Material masked = blended(material(0), material(1), picture(0, 1), 0.8f);
  masked.opacity = gray(0.6f);
  return {
      {"diffuse and metal", blended(material(0), material(1), picture(0.1f, 0.9f))},
      {"twosided", blended(material(0, 0, true), material(1, 1, true), quarter)},
      {"metal and glass", blended(material(1), material(3), quarter), true},
      {"with mirrors",
       blended(material(2), blended(material(4), material(0), quarter), gray(0.5f), 0.7f)},
      {"masked", masked, true},
      // Three lobes each.
      {"coat", material(5)},
      {"rough coat", material(6, 6, true)},
      {"blend of coats", blended(material(5), material(6), quarter)},
  };
}

// All that does not go on by a delta lobe.
TEST(MaterialSampling, DensitiesMatchByChiSquare) {
  const std::vector<MaterialCase> cases = materialCases();
  std::uint64_t stream = 0;
  for (const MaterialCase& c : cases)
    for (const float cosine : {0.9f, 0.4f}) {
      const Vec3f wi = direction(cosine, 0.7f);
      const Vec3<double> in = glm::normalize(Vec3<double>(wi));
      Random random(23, ++stream, 0);
      DirectionHistogram cells(Vec3<double>(-in.x, -in.y, in.z), 14);
      for (int i = 0; i < 100000; ++i) {
        const float u0 = random.uniform(), u1 = random.uniform();
        const LobeId lobe = chooseLobe(bsdfs(), c.material, kUv, wi, u0, u1, random.uniform());
        const Vec3f wo = isDelta(bsdfs(), c.material, lobe)
                             ? noDirection<float>()
                             : sampleMaterial<float>(bsdfs(), c.material, kUv, wi, lobe, u0, u1);
        if (evaluateMaterial<float>(bsdfs(), c.material, kUv, wi, wo).pdf > 0)
          cells.add(wo);
        else
          cells.addNothing();
      }
      const auto verdict = cells.test(
          [&](const Vec3<double>& wo) {
            return evaluateMaterial<double>(bsdfs(), c.material, Vec2<double>(kUv), in, wo).pdf;
          },
          2 * static_cast<int>(cases.size()));
      EXPECT_TRUE(verdict.passed) << c.name << ", cosine " << cosine << ": " << verdict.message;
    }
}

// The lobe that is drawn for a choice owns an interval with the choice in it; its coordinates are found again;
// the shares of all lobes make the density; the weight of a draw is its value over that.
TEST(MaterialSampling, LobesAreFoundAgain) {
  Random random(24, 1, 0);
  for (const MaterialCase& c : materialCases()) {
    int checked = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3f wi = direction(0.1f + 0.9f * random.uniform(), 6 * random.uniform());
      const float u0 = random.uniform(), u1 = random.uniform(), choice = random.uniform();
      const LobeId lobe = chooseLobe(bsdfs(), c.material, kUv, wi, u0, u1, choice);
      const ChoiceInterval interval = choiceInterval(bsdfs(), c.material, kUv, wi, u0, u1, lobe);
      EXPECT_GE(choice, interval.begin - 1e-6f) << c.name;
      EXPECT_LE(choice, interval.end + 1e-6f) << c.name;
      if (isDelta(bsdfs(), c.material, lobe)) {
        if (lobe.null) continue;
        const auto d = sampleDelta<float>(bsdfs(), c.material, kUv, wi, lobe);
        EXPECT_NEAR(d.probability, interval.end - interval.begin, 1e-5f) << c.name;
        continue;
      }
      const Vec3f wo = sampleMaterial<float>(bsdfs(), c.material, kUv, wi, lobe, u0, u1);
      const auto e = evaluateMaterial<float>(bsdfs(), c.material, kUv, wi, wo);
      const float share = lobePdf<float>(bsdfs(), c.material, kUv, wi, wo, lobe);
      if (!(share > 0)) continue;
      ++checked;
      EXPECT_LE(share, e.pdf * 1.00001f) << c.name;
      Vec2f u;
      ASSERT_TRUE(invertLobe(bsdfs(), c.material, kUv, wi, wo, lobe, u)) << c.name;
      EXPECT_NEAR(u.x, u0, 1e-3f) << c.name;
      const auto s = sampledMaterial<float>(bsdfs(), c.material, kUv, wi, wo);
      EXPECT_NEAR(s.pdf, e.pdf, 1e-5f * e.pdf) << c.name;
      EXPECT_NEAR(s.weight.y, e.value.y / e.pdf, 1e-4f * (1 + s.weight.y)) << c.name;
      // drawLobe gives this lobe with its share of the density.
      int hits = 0;
      const int draws = 64;
      for (int k = 0; k < draws; ++k) {
        LobeId drawn;
        ASSERT_TRUE(drawLobe(bsdfs(), c.material, kUv, wi, wo,
                             (static_cast<float>(k) + 0.5f) / draws, drawn));
        hits += drawn == lobe;
      }
      EXPECT_NEAR(hits, draws * share / e.pdf, 2.5) << c.name;
    }
    EXPECT_GT(checked, 500) << c.name;
  }
}

// Light of one direction comes back as the sum of what the parts send back, by their weights.
TEST(MaterialSampling, AlbedoIsTheWeightedSum) {
  const auto albedo = [](const Material& m, const Vec3f& wi, std::uint64_t stream, double& error) {
    Random random(25, stream, 0);
    constexpr int kDraws = 200000;
    double sum = 0, sum2 = 0;
    for (int i = 0; i < kDraws; ++i) {
      const float u0 = random.uniform(), u1 = random.uniform();
      const LobeId lobe = chooseLobe(bsdfs(), m, kUv, wi, u0, u1, random.uniform());
      double w = 0;
      if (isDelta(bsdfs(), m, lobe)) {
        w = sampleDelta<float>(bsdfs(), m, kUv, wi, lobe).importance.y;
      } else {
        const Vec3f wo = sampleMaterial<float>(bsdfs(), m, kUv, wi, lobe, u0, u1);
        w = sampledMaterial<float>(bsdfs(), m, kUv, wi, wo).weight.y;
      }
      sum += w;
      sum2 += w * w;
    }
    const double mean = sum / kDraws;
    error = std::sqrt(std::max(0.0, sum2 / kDraws - mean * mean) / kDraws);
    return mean;
  };
  const Vec3f wi = direction(0.7f, 0.3f);
  double whole, first, second;
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 0}, {4, 2}}) {
    const Material m = blended(material(a), material(b), gray(0.3f), 0.8f);
    const double expected =
        0.8 * (0.7 * albedo(material(a), wi, 1, first) + 0.3 * albedo(material(b), wi, 2, second));
    EXPECT_NEAR(albedo(m, wi, 3, whole), expected, 5 * (whole + first + second) + 1e-6)
        << a << " and " << b;
  }
}

}  // namespace
}  // namespace h2mc
