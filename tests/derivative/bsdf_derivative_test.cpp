// SPDX-License-Identifier: MIT
// Derivatives of the BSDFs through the AD type: against finite differences, against the densities
// (pdf = 1 / |Jacobian| of the sampling), and finite where float is strained.
#include <gtest/gtest.h>

#include "ad/finite_difference.h"
#include "bsdf_cases.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

using namespace test;

template <class T>
Vec3<T> spherical(const T& theta, const T& phi) {
  T s, c, sp, cp;
  ad::sincos(theta, s, c);
  ad::sincos(phi, sp, cp);
  return {s * cp, s * sp, c};
}

// Probability that (u0, u1) go to the lobe that `choice` draws: between where chooseLobe changes its mind.
template <class B>
double lobeProbability(const B& b, const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                       float choice) {
  const int lobe = b.chooseLobe(uv, wi, u0, u1, choice);
  const auto edge = [&](float outside) {
    float inside = choice;
    if (b.chooseLobe(uv, wi, u0, u1, outside) == lobe) return outside;
    for (int i = 0; i < 30; ++i) {
      const float middle = 0.5f * (inside + outside);
      (b.chooseLobe(uv, wi, u0, u1, middle) == lobe ? inside : outside) = middle;
    }
    return outside;
  };
  const float end = edge(0x1.fffffep-1f);
  return (end == 0x1.fffffep-1f ? 1 : double(end)) - edge(0);
}

TEST(BsdfDerivative, DensityIsTheInverseJacobianOfSampling) {
  using D = ad::Dual2<double, 2>;
  Random random(30, 1, 0);
  const Vec2f uv(0.3f, 0.4f);
  int checked = 0;
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          for (int trial = 0; trial < 60; ++trial) {
            const float side = c.entersBack && random.uniform() < 0.5f ? -1.0f : 1.0f;
            const Vec3f wi =
                direction(side * (0.05f + 0.94f * random.uniform()), 6 * random.uniform());
            const Vec3<double> in = glm::normalize(Vec3<double>(wi));
            const float u0 = 0.01f + 0.97f * random.uniform(), u1 = random.uniform();
            const float choice = random.uniform();
            const int lobe = b.chooseLobe(uv, wi, u0, u1, choice);
            if (b.isDelta(lobe)) continue;
            const Vec3<D> wo = b.template sample<D>(Vec2<D>(D(uv.x), D(uv.y)), {in.x, in.y, in.z},
                                                    lobe, D::variable(u0, 0), D::variable(u1, 1));
            const Vec3<double> out = value3(wo);
            const double pdf = b.template lobePdf<double>(Vec2<double>(uv), in, out, lobe);
            if (!(pdf > 0)) continue;
            EXPECT_NEAR(glm::length(out), 1, 1e-12);
            const Vec3<double> d0(wo.x.gradient(0), wo.y.gradient(0), wo.z.gradient(0));
            const Vec3<double> d1(wo.x.gradient(1), wo.y.gradient(1), wo.z.gradient(1));
            const double jacobian = glm::length(glm::cross(d0, d1));
            const double probability = lobeProbability(b, uv, wi, u0, u1, choice);
            // The probability comes from float comparisons.
            EXPECT_NEAR(pdf * jacobian / probability, 1, 2e-6 / probability + 2e-5)
                << c.name << ", lobe " << lobe << ", wi.z " << wi.z << ", u " << u0 << " " << u1;
            ++checked;
          }
        },
        c.bsdf);
  }
  EXPECT_GT(checked, 600);
}

// What float loses: the weight of a drawn direction varies slowly where the cosine and the density that it
// is the quotient of do not, towards the horizon.
TEST(BsdfDerivative, WeightsAreAsGoodInFloat) {
  using F = ad::Dual2<float, 4>;
  using D = ad::Dual2<double, 4>;
  const std::vector<Bsdf> bsdfs = {
      diffuse({0.5f, 0.5f, 0.5f}),
      phong(0.4f, 0.3f, 50),
      roughConductor(facets(kGgx, 0.05f)),
      roughConductor(facets(kBeckmann, 0.05f)),
      roughDielectric(facets(kGgx, 0.05f), 1.5f),
      roughPlastic(facets(kGgx, 0.1f), {0.6f, 0.3f, 0.1f}, 1.5f, false),
      coating(1.5f, phong(0.4f, 0.3f, 50)),
      roughCoating(facets(kGgx, 0.1f), 1.5f, diffuse(Rgbf(0.5f)), Rgbf(0.2f)),
      FurtherBsdf{principled({0.3f, 0.2f, 0.5f}, kPrincipledAll, 1.4f)}};
  int checked = 0;
  for (int b = 0; b < static_cast<int>(bsdfs.size()); ++b) {
    const Material m = material(b);
    for (const float u0 : {0.3f, 0.9f, 0.995f})
      for (const float choice : {0.01f, 0.5f, 0.99f})
        for (const float cosine : {0.9f, 0.3f, -0.78f}) {
          const bool inside = cosine < 0;
          if (inside && !std::holds_alternative<RoughDielectric>(bsdfs[std::size_t(b)])) continue;
          const Vec3f wi = direction(cosine, 0.4f);
          const LobeId lobe = chooseLobe(bsdfs, m, Vec2f(0), wi, u0, 0.37f, choice);
          const auto log = [&]<class T>(T theta, T phi, T v0, T v1) {
            const Vec3<T> in = spherical<T>(theta, phi);
            const Vec3<T> out =
                sampleMaterial<T>(bsdfs, m, Vec2<T>(T(0.f), T(0.f)), in, lobe, v0, v1);
            const auto s = sampledMaterial<T>(bsdfs, m, Vec2<T>(T(0.f), T(0.f)), in, out);
            return value(s.pdf) > 0 ? T(ad::log(luminance(s.weight))) : T(0.f);
          };
          const double theta = std::acos(static_cast<double>(cosine));
          const F f = log(F::variable(static_cast<float>(theta), 0), F::variable(0.4f, 1),
                          F::variable(u0, 2), F::variable(0.37f, 3));
          const D d = log(D::variable(static_cast<float>(theta), 0), D::variable(double(0.4f), 1),
                          D::variable(double(u0), 2), D::variable(double(0.37f), 3));
          checked += d.v != 0;
          double scale = 1;
          for (int i = 0; i < 4; ++i)
            for (int j = 0; j <= i; ++j) scale = std::max(scale, std::abs(d.hessian(i, j)));
          for (int i = 0; i < 4; ++i)
            for (int j = 0; j <= i; ++j)
              EXPECT_NEAR(f.hessian(i, j), d.hessian(i, j), 1e-3 * scale)
                  << b << " u0 " << u0 << " cosine " << cosine << " lobe " << int(lobe.lobe);
        }
  }
  EXPECT_GT(checked, 60);
}

// Whether a difference of angles up to `reach` at this cosine crosses alpha tan = 1 / 1.6, where the rational
// approximation of the masking [Walter et al. 2007, eq. 27 and below] has a knot: its second derivative jumps.
template <class B>
bool crossesMaskingKnot(const B& b, const Vec2f& uv, float cosine, double reach) {
  if constexpr (std::is_base_of_v<FacetSurface, B>) {
    return b.withFacets(uv, [&](const auto& facets) {
      const double alpha = facets.alpha, angle = std::acos(std::abs(cosine));
      return facets.distribution != FacetDistribution::kGgx &&
             std::abs(angle - std::atan(1 / (1.6 * alpha))) < reach;
    });
  }
  return false;
}

// log of value, pdf, pdfReverse and weight by the angles of both directions, where all are well away from
// zero, from the horizon and from the critical angle.
TEST(BsdfDerivative, MatchesFiniteDifferences) {
  using D = ad::Dual2<double, 4>;
  Random random(31, 1, 0);
  const Vec2f uv(0.3f, 0.4f);
  int checked = 0, atKnots = 0;
  for (const BsdfCase& c : glossyCases()) {
    std::visit(
        [&](const auto& b) {
          for (int trial = 0; trial < 12; ++trial) {
            const float side = c.entersBack && random.uniform() < 0.5f ? -1.0f : 1.0f;
            const float cosine = side * (0.2f + 0.75f * random.uniform());
            const Vec3f wi = direction(cosine, 6 * random.uniform());
            const float u0 = 0.05f + 0.85f * random.uniform(), u1 = random.uniform();
            const int lobe = b.chooseLobe(uv, wi, u0, u1, random.uniform());
            if (b.isDelta(lobe)) continue;
            const Vec3f wo = b.template sample<float>(uv, wi, lobe, u0, u1);
            if (std::abs(wo.z) < 0.1f) continue;
            constexpr double h = 2e-4;  // of the differences below, which reach to 4 h
            if (crossesMaskingKnot(b, uv, wi.z, 4 * h) || crossesMaskingKnot(b, uv, wo.z, 4 * h)) {
              ++atKnots;
              continue;
            }
            const double at[4] = {std::acos(wi.z), std::atan2(wi.y, wi.x), std::acos(wo.z),
                                  std::atan2(wo.y, wo.x)};
            for (int which = 0; which < 4; ++which) {
              const auto f = [&](const auto* x) {
                using T = std::remove_cvref_t<decltype(x[0])>;
                const Vec2<T> at(T(uv.x), T(uv.y));
                const Vec3<T> in = spherical<T>(x[0], x[1]), out = spherical<T>(x[2], x[3]);
                if (which == 3)
                  return T(ad::log(luminance(
                      sampledMaterial<T>(std::span(&c.bsdf, 1), material(0), at, in, out).weight)));
                const auto e = b.template evaluate<T>(at, in, out);
                return T(
                    ad::log(which == 0 ? luminance(e.value) : (which == 1 ? e.pdf : e.pdfReverse)));
              };
              D x[4];
              for (int i = 0; i < 4; ++i) x[i] = D::variable(at[i], i);
              const D y = f(x);
              if (!(y.v > -12)) continue;
              const auto g = [&](int i, double h, int j, double k) {
                double p[4] = {at[0], at[1], at[2], at[3]};
                p[i] += h;
                p[j] += k;
                return f(p);
              };
              ++checked;
              // The third derivative of the coat's spline jumps at its knots.
              const double tolerance = hasSpline(c.bsdf) ? 4e-3 : 1e-4;
              double scale = 1;
              for (int i = 0; i < 4; ++i)
                for (int j = 0; j <= i; ++j) scale = std::max(scale, std::abs(y.hessian(i, j)));
              for (int i = 0; i < 4; ++i) {
                // Five points in each direction: errors of order h^4.
                const double slope = (8 * (g(i, h, i, 0) - g(i, -h, i, 0)) -
                                      (g(i, 2 * h, i, 0) - g(i, -2 * h, i, 0))) /
                                     (12 * h);
                EXPECT_NEAR(y.gradient(i), slope, 1e-6 * scale) << c.name << " " << which;
                for (int j = 0; j <= i; ++j) {
                  const auto mixed = [&](double s) {
                    return (g(i, s, j, s) - g(i, s, j, -s) - g(i, -s, j, s) + g(i, -s, j, -s)) /
                           (4 * s * s);
                  };
                  // At i = j the steps add up: (f(2s) - 2 f(0) + f(-2s)) / (2s)^2.
                  const double second = (4 * mixed(h) - mixed(2 * h)) / 3;
                  EXPECT_NEAR(y.hessian(i, j), second, tolerance * scale)
                      << c.name << " " << which << " (" << i << ", " << j << ")";
                }
              }
            }
          }
        },
        c.bsdf);
  }
  EXPECT_GT(checked, 300);
  EXPECT_LT(atKnots, 5);
}

// Values and derivatives in float stay finite wherever something is scattered: small roughness,
// grazing angles, both ends of u0.
TEST(BsdfDerivative, FiniteInFloatUnderStrain) {
  using D = ad::Dual2<float, 4>;
  std::vector<BsdfCase> cases = glossyCases();
  for (const float alpha : {1e-3f, 1e-2f, 1.0f}) {
    for (const auto d : {kGgx, kBeckmann}) {
      cases.push_back({"roughconductor", roughConductor(facets(d, alpha), gold())});
      cases.push_back({"roughdielectric", roughDielectric(facets(d, alpha), 1.5f), true});
      cases.push_back({"roughplastic", roughPlastic(facets(d, alpha), Rgbf(0.5f), 1.5f, true)});
      cases.push_back({"coating", coating(1.5f, roughConductor(facets(d, alpha), gold()))});
      cases.push_back(
          {"coating dark", coating(1.33f, phong(0.5f, 0.3f, 1 / (alpha * alpha)), Rgbf(1e4f))});
      cases.push_back({"coating inverted", coating(0.7f, roughConductor(facets(d, alpha)))});
      cases.push_back(
          {"roughcoating", roughCoating(facets(d, alpha), 1.5f, diffuse(Rgbf(0.5f)), Rgbf(2))});
    }
  }
  for (const BsdfCase& c : extremePrincipled()) cases.push_back(c);
  Random random(32, 1, 0);
  const Vec2f uv(0.3f, 0.4f);
  int finite = 0, all = 0;
  for (const BsdfCase& c : cases) {
    std::visit(
        [&](const auto& b) {
          for (int trial = 0; trial < 300; ++trial) {
            const float side = c.entersBack && random.uniform() < 0.5f ? -1.0f : 1.0f;
            const float grazing = random.uniform() < 0.3f ? 1e-3f : 1.0f;
            const Vec3f wi =
                direction(side * std::max(1e-6f, grazing * random.uniform()), 6 * random.uniform());
            const float u0 =
                random.uniform() < 0.1f ? 0x1p-24f * (random.next() % 4) : random.uniform();
            const float u1 = random.uniform();
            const int lobe = b.chooseLobe(uv, wi, u0, u1, random.uniform());
            const Vec3<D> in(D::variable(wi.x, 0), D::variable(wi.y, 1), D(wi.z));
            const Vec2<D> duv{D(uv.x), D(uv.y)};
            if (b.isDelta(lobe)) continue;
            const Vec3<D> wo =
                b.template sample<D>(duv, in, lobe, D::variable(u0, 2), D::variable(u1, 3));
            const auto e = b.template evaluate<D>(duv, in, wo);
            EXPECT_TRUE(std::isfinite(value(e.value.x)) && std::isfinite(value(e.pdf)) &&
                        std::isfinite(value(e.pdfReverse)))
                << c.name;
            if (!(value(e.pdf) > 0 && value(e.value.x) > 0)) continue;
            ++all;
            finite += isFinite(e.value.x) && isFinite(e.pdf) && isFinite(e.pdfReverse);
          }
        },
        c.bsdf);
  }
  EXPECT_GT(all, 3000);
  EXPECT_EQ(finite, all);
}

}  // namespace
}  // namespace h2mc
