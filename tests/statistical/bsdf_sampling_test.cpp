// SPDX-License-Identifier: MIT
// The BSDFs' sampling against what they say of it: densities by chi-square, albedos by quadrature.
// Thresholds: see chi_square.h for the false alarms; means are held to 5 standard errors (a false
// alarm in 1.7 million) or, where quadrature limits, to what is said beside them.
#include <gtest/gtest.h>

#include "bsdf_cases.h"
#include "chi_square.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

using namespace test;

const Vec2f kUv(0.3f, 0.4f);

// Angles of incidence that a case is tried at; negative: from inside.
std::vector<float> cosines(const BsdfCase& c) {
  if (c.entersBack) return {0.95f, 0.4f, 0.05f, -0.97f, -0.5f, -0.1f};
  return {0.98f, 0.5f, 0.05f};
}

// Around which a lobe gathers: the mirror direction or its refraction, the normal for wide lobes.
template <class B>
Vec3<double> lobeAxis(const B& b, const Vec3f& wi, int lobe) {
  if (b.width(lobe) > 1) return {0, 0, 1};
  if (const double index = roughIndex(b); index != 1) {
    static_assert(RoughDielectric::kTransmit == 1 && Principled::kTransmit == 1);
    if (lobe == 1) {
      const double eta = wi.z > 0 ? 1 / index : index;
      const double x = -wi.x * eta, y = -wi.y * eta, s2 = x * x + y * y;
      return {x, y, std::sqrt(std::max(0.0, 1 - s2)) * (wi.z > 0 ? -1 : 1)};
    }
  }
  return {-wi.x, -wi.y, wi.z};
}

// Enough for the innermost ring to resolve the lobe.
int rings(float width) { return width > 0 && width < 0.1f ? 40 : 14; }

TEST(BsdfSampling, DensitiesMatchByChiSquare) {
  int tests = 0;
  for (const BsdfCase& c : glossyCases()) tests += 2 * static_cast<int>(cosines(c).size());
  std::uint64_t stream = 0;
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          using B = std::remove_cvref_t<decltype(b)>;
          for (const float cosine : cosines(c)) {
            const Vec3f wi = direction(cosine, 0.7f);
            const Vec3<double> in = glm::normalize(Vec3<double>(wi));
            for (int lobe = 0; lobe < B::kLobes; ++lobe) {
              if (b.isDelta(lobe)) continue;
              Random random(20, ++stream, 0);
              DirectionHistogram cells(lobeAxis(b, wi, lobe), rings(b.width(lobe)));
              for (int i = 0; i < 60000; ++i) {
                const float u0 = random.uniform(), u1 = random.uniform();
                const int drawn = b.chooseLobe(kUv, wi, u0, u1, random.uniform());
                if (drawn != lobe) {
                  cells.addNothing();
                  continue;
                }
                const Vec3f wo = b.template sample<float>(kUv, wi, lobe, u0, u1);
                if (b.template lobePdf<float>(kUv, wi, wo, lobe) > 0)
                  cells.add(wo);
                else
                  cells.addNothing();
              }
              const auto verdict = cells.test(
                  [&](const Vec3<double>& wo) {
                    return b.template lobePdf<double>(Vec2<double>(kUv), in, wo, lobe);
                  },
                  tests);
              EXPECT_TRUE(verdict.passed) << c.name << ", cosine " << cosine << ", lobe " << lobe
                                          << ": " << verdict.message;
            }
          }
        },
        c.bsdf);
  }
}

// E[value / pdf] over sampling, with its standard error.
struct Mean {
  double value, error;
};
// What the weight stands for.
Rgbf reflectance(const DeltaSample<float>& d) { return d.importance * d.probability; }
template <class B>
Mean sampledAlbedo(const B& b, const Vec3f& wi, int draws, std::uint64_t stream) {
  Random random(21, stream, 0);
  double sum = 0, sum2 = 0;
  for (int i = 0; i < draws; ++i) {
    const float u0 = random.uniform(), u1 = random.uniform();
    const int lobe = b.chooseLobe(kUv, wi, u0, u1, random.uniform());
    double w = 0;
    if (b.isDelta(lobe)) {
      const auto d = b.template sampleDelta<float>(kUv, wi, lobe);
      w = d.importance.y;
    } else {
      const Vec3f wo = b.template sample<float>(kUv, wi, lobe, u0, u1);
      const auto e = b.template evaluate<float>(kUv, wi, wo);
      // As importance, so that energy is conserved through refraction too.
      const double index = wi.z * wo.z > 0 ? 1 : wi.z > 0 ? roughIndex(b) : 1 / roughIndex(b);
      const double scale = index * index;
      if (e.pdf > 0) w = scale * e.value.y / e.pdf;
    }
    sum += w;
    sum2 += w * w;
  }
  const double mean = sum / draws;
  return {mean, std::sqrt(std::max(0.0, sum2 / draws - mean * mean) / draws)};
}

TEST(BsdfSampling, AlbedoIsAtMostOneAndMatchesQuadrature) {
  std::uint64_t stream = 0;
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          using B = std::remove_cvref_t<decltype(b)>;
          for (const float cosine : cosines(c)) {
            const Vec3f wi = direction(cosine, 0.7f);
            const Vec3<double> in = glm::normalize(Vec3<double>(wi));
            const Mean sampled = sampledAlbedo(b, wi, 40000, ++stream);
            EXPECT_LE(sampled.value, 1 + 5 * sampled.error + 1e-6) << c.name << " " << cosine;
            EXPECT_GT(sampled.value, 0) << c.name << " " << cosine;
            double integral = 0;
            for (int lobe = 0; lobe < B::kLobes; ++lobe)
              if (b.isDelta(lobe))
                integral += reflectance(b.template sampleDelta<float>(kUv, wi, lobe)).y;
            for (const int side : {1, -1}) {
              int lobe = c.entersBack && side * cosine < 0 ? 1 : 0;
              if (lobe == 0 && b.isDelta(0) && b.hasNonDelta() && !b.isDelta(1)) lobe = 1;
              const double index = side * cosine > 0 ? 1
                                   : wi.z > 0        ? roughIndex(b)
                                                     : 1 / roughIndex(b);
              const double scale = index * index;
              const DirectionHistogram sphere(
                  b.isDelta(lobe) ? Vec3<double>(0, 0, 1) : lobeAxis(b, wi, lobe),
                  rings(b.width(lobe)));
              integral += scale * sphere.integral([&](const Vec3<double>& wo) {
                return wo.z * side > 0
                           ? b.template evaluate<double>(Vec2<double>(kUv), in, wo).value.y
                           : 0.0;
              });
            }
            EXPECT_NEAR(sampled.value, integral, 5 * sampled.error + 2e-4)
                << c.name << ", cosine " << cosine;
          }
        },
        c.bsdf);
  }
}

// A surface that absorbs nothing and loses nothing to masking (smooth, or nearly so).
TEST(BsdfSampling, LosslessSurfacesReflectEverything) {
  const auto expectOne = [](const auto& b, const char* name, double tolerance) {
    for (const float cosine : {1.0f, 0.7f, 0.2f}) {
      const Mean m = sampledAlbedo(b, direction(cosine, 0.3f), 20000, 1);
      EXPECT_NEAR(m.value, 1, 5 * m.error + tolerance) << name << ", cosine " << cosine;
    }
  };
  expectOne(conductor(), "conductor none", 1e-6);
  expectOne(dielectric(1.5f), "dielectric", 1e-5);
  expectOne(dielectric(1 / 1.5f), "dielectric inverted", 1e-5);
  expectOne(thinDielectric(1.5f), "thindielectric", 1e-5);
  expectOne(diffuseTransmitter(Rgbf(1)), "difftrans", 1e-5);
  expectOne(roughConductor(facets(kPhong, 0.001f)), "roughconductor phong", 2e-4);
  expectOne(diffuse(Rgbf(1)), "diffuse", 1e-5);
  expectOne(roughConductor(facets(kGgx, 0.001f)), "roughconductor ggx", 2e-4);
  expectOne(roughConductor(facets(kBeckmann, 0.001f)), "roughconductor beckmann", 2e-4);
  expectOne(roughDielectric(facets(kGgx, 0.001f), 1.5f), "roughdielectric", 2e-4);
}

// Without light in the layer but what goes through it twice: of white paper the share that enters and leaves
// again, of a mirror that which enters and leaves at the same angle.
TEST(BsdfSampling, CoatsOfWhiteAndMirrorsReflectWhatPassesThem) {
  const float eta = 1.5f;
  const Microfacet f = facets(kGgx, 0.1f);
  const RoughTransmittance table(f, eta);
  for (const float cosine : {1.0f, 0.6f, 0.2f}) {
    const Vec3f wi = direction(cosine, 0.3f);
    const double t = transmitDielectric(double(cosine), double(eta));
    const Mean white = sampledAlbedo(coating(eta, diffuse(Rgbf(1))), wi, 40000, 1);
    EXPECT_NEAR(white.value, 1 - t + t * (1 - fresnelDiffuse(eta)) / (eta * eta),
                5 * white.error + 1e-5);
    const Mean mirror = sampledAlbedo(coating(eta, conductor()), wi, 40000, 2);
    EXPECT_NEAR(mirror.value, 1 - t + t * t, 5 * mirror.error + 1e-5);
    const double rough = table.evaluate(double(cosine));
    double through = 0;  // 2 int T c dc
    for (int i = 0; i < 1000; ++i) {
      const double c = (i + 0.5) / 1000;
      through += 2 * table.evaluate(c) * c / 1000;
    }
    const auto darkened = [&](const Bsdf& below) {
      FurtherBsdf b = roughCoating(f, eta, below);
      std::get<RoughCoat>(b.bsdf).specular = gray(0);
      return b;
    };
    const Mean paper = sampledAlbedo(darkened(diffuse(Rgbf(1))), wi, 40000, 3);
    EXPECT_NEAR(paper.value, rough * through / (eta * eta), 5 * paper.error + 1e-5);
    const Mean under = sampledAlbedo(darkened(conductor()), wi, 40000, 4);
    EXPECT_NEAR(under.value, rough * rough, 5 * under.error + 1e-5);
  }
}

// The coat and its base together: uniform light from everywhere comes back whole. For a smooth coat
// the model conserves energy for diffuse light.
TEST(BsdfSampling, WhitePlasticConservesDiffuseLight) {
  const Plastic b = plastic(Rgbf(1), 1.5f, false);
  Random random(22, 1, 0);
  double sum = 0;
  const int draws = 40000;
  for (int i = 0; i < draws; ++i) {
    const Vec3f wi = sampleCosine(random.uniform(), random.uniform());
    if (!(wi.z > 0)) continue;
    sum += sampledAlbedo(b, wi, 1, static_cast<std::uint64_t>(i)).value;
  }
  EXPECT_NEAR(sum / draws, 1, 0.01);
}

}  // namespace
}  // namespace h2mc
