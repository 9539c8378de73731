// SPDX-License-Identifier: MIT
// What the BSDFs promise, pointwise: reciprocity, consistent densities, exact inverses, delta lobes,
// and finite numbers for any unit vectors.
#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "render/bsdf/quadrature.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

using namespace test;

const Vec2f kUv(0.3f, 0.4f);

Vec3f randomDirection(Random& random, bool anySide) {
  const float z = 0.01f + 0.98f * random.uniform();
  return direction(anySide && random.uniform() < 0.5f ? -z : z, 6.28f * random.uniform());
}

// f(wi, wo) = f(wo, wi) within a side; across, f eta_o^2 is symmetric [Veach 1997, eq. 5.14].
TEST(Bsdf, IsReciprocal) {
  Random random(40, 1, 0);
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          const double eta = roughIndex(b);
          for (int i = 0; i < 500; ++i) {
            const Vec3<double> wi(randomDirection(random, c.entersBack));
            const Vec3<double> wo(randomDirection(random, c.entersBack));
            const Vec2<double> uv(kUv);
            const auto e = b.template evaluate<double>(uv, wi, wo);
            const auto r = b.template evaluate<double>(uv, wo, wi);
            const double ni = wi.z < 0 ? eta : 1, no = wo.z < 0 ? eta : 1;
            for (int k = 0; k < 3; ++k) {
              const double forward = e.value[k] / std::abs(wo.z) * no * no;
              const double backward = r.value[k] / std::abs(wi.z) * ni * ni;
              EXPECT_NEAR(forward, backward, 1e-9 * (1 + forward)) << c.name;
            }
            EXPECT_NEAR(e.pdf, r.pdfReverse, 1e-9 * (1 + e.pdf)) << c.name;
            EXPECT_NEAR(e.pdfReverse, r.pdf, 1e-9 * (1 + r.pdf)) << c.name;
          }
        },
        c.bsdf);
  }
}

TEST(Bsdf, LobeDensitiesAddUp) {
  Random random(41, 1, 0);
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          using B = std::remove_cvref_t<decltype(b)>;
          for (int i = 0; i < 300; ++i) {
            const Vec3f wi = randomDirection(random, c.entersBack);
            const Vec3f wo = randomDirection(random, true);
            float sum = 0;
            for (int lobe = 0; lobe < B::kLobes; ++lobe)
              sum += b.template lobePdf<float>(kUv, wi, wo, lobe);
            const float pdf = b.template evaluate<float>(kUv, wi, wo).pdf;
            EXPECT_NEAR(sum, pdf, 1e-5f * (1 + pdf)) << c.name;
          }
        },
        c.bsdf);
  }
}

TEST(Bsdf, InvertGivesBackTheCoordinates) {
  Random random(42, 1, 0);
  int checked = 0;
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          for (int i = 0; i < 2000; ++i) {
            const Vec3f wi = randomDirection(random, c.entersBack);
            const float u0 = random.uniform(), u1 = random.uniform();
            const int lobe = b.chooseLobe(kUv, wi, u0, u1, random.uniform());
            if (b.isDelta(lobe)) continue;
            const Vec3f wo = b.template sample<float>(kUv, wi, lobe, u0, u1);
            if (!(b.template lobePdf<float>(kUv, wi, wo, lobe) > 0)) continue;
            Vec2f u;
            ASSERT_TRUE(b.invert(kUv, wi, wo, lobe, u)) << c.name;
            // A direction is good to about 1e-7; how far that moves a coordinate depends on the
            // lobe's width and, for the azimuth, on the distance from the pole.
            const float slack = 5e-6f / std::min(1.0f, b.width(lobe));
            float turn = std::abs(u.y - u1);
            turn = std::min(turn, 1 - turn) * std::sqrt(u0 * (1 - u0));
            EXPECT_NEAR(u.x, u0, slack) << c.name << ", wi.z " << wi.z;
            EXPECT_NEAR(turn, 0, slack) << c.name << ", wi.z " << wi.z;
            EXPECT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
            const Vec3f again = b.template sample<float>(kUv, wi, lobe, u.x, u.y);
            // What leaves a layer at cosine c moves by 1 / c times a coordinate's last digit.
            const float layer = isCoat(c.bsdf) ? 5e-7f / wo.z : 0;
            EXPECT_LT(glm::length(again - wo), std::max(2e-5f, layer))
                << c.name << ", u " << u0 << " " << u1;
            ++checked;
          }
        },
        c.bsdf);
  }
  EXPECT_GT(checked, 15000);
}

TEST(Bsdf, AzimuthWraps) {
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          for (int lobe = 0; lobe < std::remove_cvref_t<decltype(b)>::kLobes; ++lobe) {
            if (b.isDelta(lobe)) continue;
            const Vec3f wi = direction(0.8f, 1);
            const Vec3f a = b.template sample<float>(kUv, wi, lobe, 0.3f, 0.0f);
            const Vec3f z = b.template sample<float>(kUv, wi, lobe, 0.3f, 0x1.fffffep-1f);
            EXPECT_LT(glm::length(a - z), 1e-5f) << c.name;
          }
        },
        c.bsdf);
  }
}

// Whatever unit vectors come, the numbers are finite, not negative, and directions are unit.
TEST(Bsdf, FiniteForAllUnitVectors) {
  std::vector<BsdfCase> cases = glossyCases();
  for (const float alpha : {1e-4f, 1e-3f, 2.0f})
    for (const auto d : {kGgx, kBeckmann}) {
      cases.push_back({"roughconductor", roughConductor(facets(d, alpha), gold())});
      cases.push_back({"roughdielectric", roughDielectric(facets(d, alpha), 1.5f), true});
      cases.push_back({"roughdielectric air", roughDielectric(facets(d, alpha), 1.000277f), true});
      cases.push_back({"roughplastic", roughPlastic(facets(d, alpha), Rgbf(0.5f), 1.5f, true)});
      cases.push_back({"coating", coating(1.5f, roughConductor(facets(d, alpha), gold()))});
      cases.push_back(
          {"roughcoating", roughCoating(facets(d, alpha), 1.5f, diffuse(Rgbf(0.5f)), Rgbf(1e4f))});
      cases.push_back(
          {"roughcoating inverted", roughCoating(facets(d, alpha), 0.7f, diffuse(Rgbf(0.5f)))});
    }
  cases.push_back({"coating air", coating(1.000277f, diffuse(Rgbf(0.5f)), Rgbf(0.1f))});
  cases.push_back({"phong 1e5", phong(0.1f, 0.9f, 1e5f)});
  for (const BsdfCase& c : extremePrincipled()) cases.push_back(c);
  cases.push_back({"phong black", phong(0, 0.9f, 10)});
  std::vector<Vec3f> extremes = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {-1, 0, -0.0f}};
  for (const float z : {1e-6f, 1e-4f, 1e-20f, 1 - 6e-8f})
    for (const float phi : {0.0f, 1.3f, 3.1415927f, 4.4f}) {
      extremes.push_back(direction(z, phi));
      extremes.push_back(direction(-z, phi));
    }
  Random random(43, 1, 0);
  for (int i = 0; i < 20; ++i) extremes.push_back(randomDirection(random, true));
  for (const BsdfCase& c : cases) {
    std::visit(
        [&](const auto& b) {
          for (const Vec3f& wi : extremes) {
            for (const Vec3f& wo : extremes) {
              const auto e = b.template evaluate<float>(kUv, wi, wo);
              for (const float x : {e.value.x, e.value.y, e.value.z, e.pdf, e.pdfReverse})
                EXPECT_TRUE(std::isfinite(x) && x >= 0)
                    << c.name << ": " << x << " at " << wi.z << ", " << wo.z;
              for (int lobe = 0; lobe < b.kLobes; ++lobe) {
                Vec2f u;
                if (b.invert(kUv, wi, wo, lobe, u)) {
                  EXPECT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1) << c.name;
                }
              }
            }
            for (const float u0 : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f})
              for (const float u1 : {0.0f, 0.7f})
                for (const float choice : {0.0f, 0x1.fffffep-1f}) {
                  const int lobe = b.chooseLobe(kUv, wi, u0, u1, choice);
                  ASSERT_TRUE(lobe >= 0 && lobe < b.kLobes);
                  if (b.isDelta(lobe)) continue;
                  const Vec3f wo = b.template sample<float>(kUv, wi, lobe, u0, u1);
                  EXPECT_NEAR(glm::length(wo), 1, 3e-6f) << c.name << " " << wi.z << " " << u0;
                }
          }
        },
        c.bsdf);
  }
}

// The closed forms are what evaluate() says of the same two directions.
TEST(Bsdf, SampledWeightIsValueOverDensity) {
  Random random(8, 3, 0);
  int weighed = 0;
  for (const BsdfCase& c : glossyCases()) {
    const std::vector<Bsdf> bsdfs = {c.bsdf};
    const Material m = material(0);
    for (int k = 0; k < 300; ++k) {
      const float side = c.entersBack && k % 2 ? -1.0f : 1.0f;
      const Vec3f wi = direction(side * (0.02f + 0.97f * random.uniform()), 6 * random.uniform());
      const float u0 = random.uniform(), u1 = random.uniform();
      const LobeId lobe = chooseLobe(bsdfs, m, kUv, wi, u0, u1, random.uniform());
      if (isDelta(bsdfs, m, lobe)) continue;
      const Vec3<double> in = glm::normalize(Vec3<double>(wi));
      const Vec3<double> out =
          glm::normalize(Vec3<double>(sampleMaterial<float>(bsdfs, m, kUv, wi, lobe, u0, u1)));
      const Vec2<double> uv(kUv);
      const auto e = evaluateMaterial<double>(bsdfs, m, uv, in, out);
      const auto s = sampledMaterial<double>(bsdfs, m, uv, in, out);
      EXPECT_NEAR(s.pdf, e.pdf, 1e-10 * e.pdf) << c.name;
      if (!(e.pdf > 0)) continue;
      ++weighed;
      EXPECT_NEAR(s.pdfReverse, e.pdfReverse, 1e-10 * e.pdfReverse) << c.name;
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(s.weight[channel] * s.pdf, e.value[channel], 1e-8 * e.value[channel])
            << c.name << " " << in.z << " " << out.z;
      // The other way round: light that comes from `in`.
      const auto reverse = evaluateMaterial<double>(bsdfs, m, uv, out, in);
      const double expected = reverse.value.y * std::abs(out.z / in.z) / s.pdf;
      EXPECT_NEAR(s.weight.y * s.importance, expected, 1e-8 * expected) << c.name;
    }
  }
  EXPECT_GT(weighed, 2000);
}

// One-sided BSDFs scatter nothing on or from the back.
TEST(Bsdf, NothingBehindOneSidedSurfaces) {
  const Vec3f up = direction(0.6f, 1), down = direction(-0.4f, 2);
  for (const BsdfCase& c : glossyCases()) {
    if (c.entersBack) continue;
    std::visit(
        [&](const auto& b) {
          EXPECT_FALSE(b.transmits());
          for (const auto& [wi, wo] : {std::pair(up, down), {down, up}, {down, down}})
            EXPECT_EQ(b.template evaluate<float>(kUv, wi, wo).pdf, 0) << c.name;
        },
        c.bsdf);
  }
}

TEST(Bsdf, MirrorsAndGlassObeySnellAndFresnel) {
  const Vec3f wi = direction(0.6f, 1);
  const auto mirror = conductor(gold()).sampleDelta<float>(kUv, wi, 0);
  EXPECT_EQ(mirror.wo, Vec3f(-wi.x, -wi.y, wi.z));
  EXPECT_EQ(mirror.probability, 1);
  // Normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
  const auto straight = conductor(gold()).sampleDelta<float>(kUv, {0, 0, 1}, 0);
  EXPECT_NEAR(straight.radiance.x, (0.857 * 0.857 + 3.98 * 3.98) / (1.143 * 1.143 + 3.98 * 3.98),
              1e-5);

  for (const float side : {1.0f, -1.0f}) {
    const Vec3f in = direction(side * 0.9f, 0.4f);
    const Dielectric glass = dielectric(1.5f);
    const float relative = side > 0 ? 1.5f : 1 / 1.5f;
    const auto r = glass.sampleDelta<float>(kUv, in, Dielectric::kReflect);
    const auto t = glass.sampleDelta<float>(kUv, in, Dielectric::kTransmit);
    EXPECT_EQ(r.importance, Rgbf(1));
    EXPECT_EQ(t.importance, Rgbf(1));
    EXPECT_NEAR(r.probability + t.probability, 1, 1e-6);
    EXPECT_NEAR(t.radiance.x, t.importance.x / (relative * relative), 1e-6);
    EXPECT_NEAR(glm::length(t.wo), 1, 1e-6);
    EXPECT_LT(t.wo.z * in.z, 0);
    EXPECT_NEAR(t.wo.x * relative, -in.x, 1e-6);
    EXPECT_NEAR(t.wo.y * relative, -in.y, 1e-6);
    // Seen from the other end the same light is bent back, with the same share.
    const auto back = glass.sampleDelta<float>(kUv, t.wo, Dielectric::kTransmit);
    EXPECT_LT(glm::length(back.wo - in), 1e-6);
    EXPECT_NEAR(back.probability, t.probability, 1e-6);
  }
  // Total reflection.
  const Vec3f shallow = direction(-0.3f, 0.4f);
  EXPECT_EQ(dielectric(1.5f).sampleDelta<float>(kUv, shallow, 0).probability, 1);
  EXPECT_EQ(dielectric(1.5f).chooseLobe(kUv, shallow, 0, 0, 0.9999f), Dielectric::kReflect);
  EXPECT_EQ(dielectric(1.5f).sampleDelta<float>(kUv, shallow, 1).radiance.x, 0);
  // Normal incidence: ((n - 1) / (n + 1))^2.
  EXPECT_NEAR(fresnelDielectric(1.0, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(transmitDielectric(1.0, 1.5), 0.96, 1e-12);
  EXPECT_NEAR(fresnelDielectric(0.3, 1.4) + transmitDielectric(0.3, 1.4), 1, 1e-12);
  // A conductor without absorption is a dielectric.
  EXPECT_NEAR(fresnelConductor(0.3, 1.4, 0.0), fresnelDielectric(0.3, 1.4), 1e-12);
  EXPECT_EQ(fresnelConductor(0.3, 0.0, 1.0), 1);
  // Known values [d'Eon and Irving 2011, for eta = 1.5 from both sides].
  EXPECT_NEAR(fresnelDiffuse(1.5), 0.0918, 1e-4);
  EXPECT_NEAR(fresnelDiffuse(1 / 1.5), 0.5963, 1e-4);
}

// Modified Phong by hand, at one pair of directions.
TEST(Bsdf, PhongByHand) {
  const Phong b = phong(0.3f, 0.5f, 20);
  const Vec3f wi = direction(0.8f, 0), wo = direction(0.7f, 3.0f);
  const double cosine = -wi.x * wo.x - wi.y * wo.y + wi.z * wo.z;
  const double lobe = std::pow(cosine, 20);
  const auto e = b.evaluate<float>(kUv, wi, wo);
  EXPECT_NEAR(e.value.x, (0.3 / kPi + 0.5 * 22 / (2 * kPi) * lobe) * wo.z, 1e-5);
  EXPECT_NEAR(e.pdf, 0.625 * 21 / (2 * kPi) * lobe + 0.375 * wo.z / kPi, 1e-5);
}

// Coats by hand, at one pair of directions, from the angles inside.
TEST(Bsdf, CoatsByHand) {
  const double eta = 1.6, thickness = 0.8;
  const Rgbf sigma(0.1f, 0.5f, 1.2f), colour(0.7f, 0.6f, 0.5f);
  const float ai = 0.9f, ao = 0.4f;
  const Vec3<double> wi(std::sin(ai), 0, std::cos(ai));
  const Vec3<double> wo(std::sin(ao) * std::cos(2.5), std::sin(ao) * std::sin(2.5), std::cos(ao));
  const double ri = std::asin(std::sin(ai) / eta), ro = std::asin(std::sin(ao) / eta);
  // Reflectance of both polarisations by the angles (Fresnel's own form).
  const auto fresnel = [](double a, double r) {
    const double s = std::sin(a - r) / std::sin(a + r), p = std::tan(a - r) / std::tan(a + r);
    return 0.5 * (s * s + p * p);
  };
  const double fi = fresnel(ai, ri), fo = fresnel(ao, ro);
  const double way = thickness * (1 / std::cos(ri) + 1 / std::cos(ro));
  const FurtherBsdf smooth = coating(1.6f, diffuse(colour), sigma);
  const auto e = smooth.evaluate<double>(Vec2<double>(kUv), wi, wo);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(e.value[k],
                (1 - fi) * (1 - fo) * std::exp(-double(sigma[k]) * way) * colour[k] / kPi *
                    std::cos(ao) / (eta * eta),
                1e-7);
  // The weights of the two lobes are 0.6 and 0.4 times what they get; below, paper stays paper.
  EXPECT_NEAR(e.pdf, 0.4 * (1 - fi) / (0.4 * (1 - fi) + 0.6 * fi) * std::cos(ao) / kPi, 1e-7);
  const auto d = smooth.sampleDelta<double>(Vec2<double>(kUv), wi, 0);
  EXPECT_NEAR(d.radiance.x * d.probability, fi, 1e-7);
  EXPECT_NEAR(d.probability, 0.6 * fi / (0.4 * (1 - fi) + 0.6 * fi), 1e-7);
  // The same by a mirror below, whose own lobe is the second.
  const FurtherBsdf over = coating(1.6f, conductor(gold()), sigma);
  const auto below = over.sampleDelta<double>(Vec2<double>(kUv), wi, 1);
  const Vec3<double> in(std::sin(ri), 0, std::cos(ri));
  const auto bare = conductor(gold()).sampleDelta<double>(Vec2<double>(kUv), in, 0);
  EXPECT_NEAR(below.wo.z, std::cos(ai), 1e-12);
  EXPECT_NEAR(below.probability + d.probability, 1, 1e-12);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(below.radiance[k] * below.probability,
                (1 - fi) * (1 - fi) * bare.radiance[k] *
                    std::exp(-2 * double(sigma[k]) * thickness / std::cos(ri)),
                1e-7);

  // Rough: the table's transmittances, and F D G / (4 cos i) of the facets.
  const Microfacet f = facets(kGgx, 0.3f);
  const RoughTransmittance table(f, 1.6f);
  const FurtherBsdf rough = roughCoating(f, 1.6f, diffuse(colour), sigma);
  const auto r = rough.evaluate<double>(Vec2<double>(kUv), wi, wo);
  const Vec3<double> h = glm::normalize(wi + wo);
  const double tan2 = (1 - h.z * h.z) / (h.z * h.z), a2 = double(0.3f) * 0.3f;
  const double density = a2 / (kPi * std::pow(h.z, 4) * (a2 + tan2) * (a2 + tan2));
  const auto masking = [&](double angle) {
    return 2 / (1 + std::sqrt(1 + a2 * std::tan(angle) * std::tan(angle)));
  };
  const double half = std::acos(glm::dot(wi, h));
  const double gloss = fresnel(half, std::asin(std::sin(half) / eta)) * density * masking(ai) *
                       masking(ao) / (4 * std::cos(ai));
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(r.value[k],
                gloss + table.evaluate(wi.z) * table.evaluate(wo.z) *
                            std::exp(-double(sigma[k]) * way) * colour[k] / kPi * std::cos(ao) /
                            (eta * eta),
                1e-6);
}

// A base of one colour is summed up when it is made, a picture of that colour at every evaluation.
TEST(Bsdf, TexturedBaseIsTheSameAsAConstantOne) {
  auto image = std::make_shared<Image>(1, 1);
  image->at(0, 0) = Rgbf(0.6f, 0.3f, 0.1f);
  BitmapTexture picture;
  picture.image = image;
  for (const bool nonlinear : {false, true}) {
    const LayeredDiffuse constant(constantTexture(image->at(0, 0)), 0.9f, 0.6, 1.5, nonlinear);
    const LayeredDiffuse textured(std::make_shared<const Texture>(picture), 0.9f, 0.6, 1.5,
                                  nonlinear);
    const Rgbf a = constant.modulated<float>(kUv, 0.7f), b = textured.modulated<float>(kUv, 0.7f);
    for (int i = 0; i < 3; ++i) {
      EXPECT_FLOAT_EQ(a[i], b[i]);
      const double d = 0.9 * image->at(0, 0)[i];
      EXPECT_NEAR(a[i], 0.7 * d / (1 - (nonlinear ? d : 1) * 0.6), 1e-6);
    }
  }
}

TEST(Bsdf, RoughTransmittanceIsTheSmoothOneWithoutRoughness) {
  for (const auto d : {kGgx, kBeckmann}) {
    const RoughTransmittance t(facets(d, 1e-3f), 1.5);
    for (const double c : {0.05, 0.3, 0.7, 1.0})
      EXPECT_NEAR(t.evaluate(c), transmitDielectric(c, 1.5), 5e-4);
    EXPECT_NEAR(t.internalReflectance(), fresnelDiffuse(1 / 1.5), 1e-4);
  }
  // The spline between its knots.
  const Microfacet f = facets(kGgx, 0.2f);
  const RoughTransmittance t(f, 1.5);
  for (double c = 1e-4; c < 1; c *= 1.7)
    EXPECT_NEAR(t.evaluate(c), RoughTransmittance::integrate(f, 1.5, c), 2e-5) << c;
}

// 2 int_0^1 T(c) c dc of what arrives from inside, with nodes gathered at the smooth interface's critical cosine.
double throughFromInside(const Microfacet& f, double eta) {
  const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
  double through = 0;
  for (const auto& [s, weight] : gaussLegendre(64)) {
    const double above = critical + (1 - critical) * s * s;
    through +=
        weight * 4 * (1 - critical) * s * above * RoughTransmittance::integrate(f, 1 / eta, above);
    if (critical > 0) {
      const double below = critical * (1 - s * s);
      through +=
          weight * 4 * critical * s * below * RoughTransmittance::integrate(f, 1 / eta, below);
    }
  }
  return through;
}

TEST(Bsdf, RoughTransmittanceIsReciprocal) {
  for (const auto d : {kGgx, kBeckmann, FacetDistribution::kPhong})
    for (const float alpha : {0.001f, 0.05f, 0.3f, 1.f})
      for (const double eta : {0.7, 1.1, 1.5, 2.4}) {
        const Microfacet f = facets(d, alpha);
        EXPECT_NEAR(1 - RoughTransmittance(f, eta).internalReflectance(), throughFromInside(f, eta),
                    1e-3)  // as well as the quadrature from inside resolves that border
            << int(d) << " " << alpha << " " << eta;
      }
}

// By drawing visible facets, for GGX, whose masking is short.
TEST(Bsdf, WhatFacetsReflectIsTheMeanOverVisibleOnes) {
  Random random(31, 4, 1);
  for (const float alpha : {0.1f, 0.5f})
    for (const double eta : {1.5, 1 / 1.5}) {
      const Microfacet f = facets(kGgx, alpha);
      for (const double c : {0.2, 0.7, 1.0}) {
        const Vec3<double> wi(std::sqrt(1 - c * c), 0, c);
        const int draws = 40000;
        double sum = 0, squares = 0;
        for (int i = 0; i < draws; ++i) {
          const Vec3<double> m = f.sample(wi, double(random.uniform()), double(random.uniform()));
          const double cosine = glm::dot(wi, m), up = 2 * cosine * m.z - c;
          if (!(up > 0)) continue;
          const double tan2 = (1 - up * up) / (up * up), a = double(alpha);
          const double x = fresnelDielectric(cosine, eta) * 2 / (1 + std::sqrt(1 + a * a * tan2));
          sum += x / draws;
          squares += x * x / draws;
        }
        const double error = std::sqrt(std::max(0.0, squares - sum * sum) / draws);
        EXPECT_NEAR(RoughTransmittance::reflected(f, eta, c), sum, 5 * error + 1e-6)
            << alpha << " " << eta << " " << c;
      }
    }
}

// How much darker diffuse reflection in the linear mode is in files of version 2 and later. The figures are those of a
// program by itself: sums over ever finer grids of facets' slopes, mean over 64 cosines.
TEST(Bsdf, RoughPlasticIsDarkerInRecentFilesTheRougherItIs) {
  const double eta = 1.49 / 1.000277;
  const float alphas[] = {0.01f, 0.1f, 0.4f, 1.f};
  const double beckmann[] = {1.022, 1.034, 1.247, 1.925}, ggx[] = {1.024, 1.104, 1.636, 2.693};
  for (int i = 0; i < 4; ++i)
    for (const auto d : {kBeckmann, kGgx}) {
      const Microfacet f = facets(d, alphas[i]);
      const double ratio = (1 - RoughTransmittance::facetsInternalReflectance(f, eta)) /
                           (1 - RoughTransmittance::shared(f, eta)->internalReflectance());
      const double expected = (d == kGgx ? ggx : beckmann)[i];
      EXPECT_NEAR(ratio, expected, 3e-3 * expected) << int(d) << " " << alphas[i];
    }
}

TEST(Bsdf, RoughTransmittanceIsSharedByEqualParameters) {
  const auto a = RoughTransmittance::shared(facets(kGgx, 0.25f), 1.5);
  EXPECT_EQ(a, RoughTransmittance::shared(facets(kGgx, 0.25f), 1.5));
  EXPECT_NE(a, RoughTransmittance::shared(facets(kGgx, 0.26f), 1.5));
  EXPECT_NE(a, RoughTransmittance::shared(facets(kBeckmann, 0.25f), 1.5));
  EXPECT_NE(a, RoughTransmittance::shared(facets(kGgx, 0.25f), 1.4));
}

}  // namespace
}  // namespace h2mc
