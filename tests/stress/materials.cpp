// SPDX-License-Identifier: MIT
// Materials at the ends of their parameters.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/bsdf/fresnel.h"
#include "stress_check.h"

namespace h2mc::test {
namespace {

class Roughness : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(Roughness, From1To1e4th) {
  const auto [bsdf, distribution] = GetParam();
  const testing::SceneFolder folder;
  for (const char* alpha : {"1", "0.1", "0.01", "1e-3", "1e-4"}) {
    const std::string text = ballScene(
        std::string("<bsdf type=\"") + bsdf + "\"><string name=\"distribution\" value=\"" +
        distribution + "\"/><float name=\"alpha\" value=\"" + alpha + "\"/></bsdf>");
    // The lamp's picture in an almost perfect mirror is for bdpt to find.
    expectSound(sceneOf(folder, text), std::string(bsdf) + " " + distribution + " " + alpha,
                {.resolved = std::stod(alpha) >= 0.1});
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, Roughness,
                         ::testing::Combine(::testing::Values("roughconductor", "roughdielectric",
                                                              "roughplastic"),
                                            ::testing::Values("ggx", "beckmann")),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param)) + "_" +
                                  std::get<1>(info.param);
                         });

TEST(Phong, ExponentsTo1e6) {
  const testing::SceneFolder folder;
  for (const char* exponent : {"1", "100", "1e4", "1e6"})
    expectSound(
        sceneOf(folder, ballScene(std::string("<bsdf type=\"phong\"><rgb "
                                              "name=\"specularReflectance\" value=\"0.6\"/><rgb "
                                              "name=\"diffuseReflectance\" value=\"0.2\"/><float "
                                              "name=\"exponent\" value=\"") +
                                  exponent + "\"/></bsdf>")),
        std::string("phong ") + exponent, {.resolved = std::stod(exponent) <= 100});
}

// Without a difference of the indices there is no interface; with a small one hardly any.
TEST(RefractiveIndex, OneAndNearlyOne) {
  const testing::SceneFolder folder;
  for (const char* index : {"1", "1.0001"})
    for (const char* bsdf : {"dielectric", "plastic", "roughdielectric", "roughplastic"}) {
      const bool rough = std::string(bsdf).starts_with("rough");
      if (rough && std::string(index) == "1") continue;  // the reader refuses it
      expectSound(
          sceneOf(folder, ballScene(std::string("<bsdf type=\"") + bsdf +
                                    "\"><float name=\"intIOR\" value=\"" + index +
                                    "\"/><float name=\"extIOR\" value=\"1\"/></bsdf>")),
          std::string(bsdf) + " of index " + index,
          // Far out in a Beckmann lobe the target is below 1e-38, and 1 / target beyond float.
          {.fallbackShare = rough ? 0.08 : 0, .resolved = false});
    }
}

// Near index 1 the amplitudes are differences of nearly equal numbers.
TEST(RefractiveIndex, FresnelTermNearOne) {
  for (const float eta : {1.0001f, 1 / 1.0001f, 1.01f, 1 / 1.01f})
    for (const float c : {1.f, 0.9f, 0.5f, 0.3f}) {
      const double exact = fresnelDielectric<double>(c, eta);
      EXPECT_NEAR(fresnelDielectric(c, eta) / exact, 1, 1e-5) << eta << " " << c;
    }
}

// A camera inside a block of glass that sees one of its faces around the critical angle, within 1e-3
// degrees and within 40, from which a lamp outside is seen at a grazing angle.
TEST(TotalReflection, AtTheCriticalAngle) {
  const testing::SceneFolder folder;
  for (const char* bsdf :
       {"<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"1.5\"/><float name=\"extIOR\" "
        "value=\"1\"/></bsdf>",
        "<bsdf type=\"roughdielectric\"><float name=\"intIOR\" value=\"1.5\"/><float "
        "name=\"extIOR\" value=\"1\"/><float name=\"alpha\" value=\"1e-3\"/></bsdf>"})
    for (const double fov : {1e-3, 40.0}) {
      const double sine = 1 / 1.5, cosine = std::sqrt(1 - sine * sine);
      const std::string text = sceneText(
          camera("0, 0, 0", std::to_string(sine) + ", 0, " + std::to_string(cosine), fov) +
          shape("cube", "<scale value=\"1\"/>", bsdf) +
          shape("sphere", "<scale value=\"20\"/>",
                "<boolean name=\"flipNormals\" value=\"true\"/>" + diffuse(0.2) + emitter("1")));
      expectSound(sceneOf(folder, text), "critical angle, fov " + std::to_string(fov),
                  {.resolved = false});
    }
}

// The Fresnel term and its derivatives on both sides of the critical angle, and at it.
TEST(TotalReflection, FresnelTerm) {
  using D = ad::Dual2<float, 1>;
  for (const float eta : {1.5f, 1.0001f, 1.f, 1 / 1.5f, 1 / 1.0001f}) {
    const float sine = eta < 1 ? eta : 1 / eta;
    const float critical = std::sqrt(std::max(0.f, 1 - sine * sine));
    std::vector<float> cosines{1, 0.5f, 1e-3f, 1e-6f};
    for (const float off : {0.f, 1e-7f, 1e-6f, 1e-4f, 1e-2f})
      cosines.insert(cosines.end(), {critical - off, critical + off});
    for (const float c : cosines) {
      if (!(c > 0) || c > 1) continue;
      const D cosine = D::variable(c, 0);
      const D reflected = fresnelDielectric(cosine, eta), passed = transmitDielectric(cosine, eta);
      for (const D& share : {reflected, passed}) {
        EXPECT_TRUE(isFinite(share)) << eta << " " << c;
        EXPECT_GE(share.v, 0) << eta << " " << c;
        EXPECT_LE(share.v, 1 + 1e-6f) << eta << " " << c;
      }
      EXPECT_NEAR(reflected.v + passed.v, 1, 1e-5) << eta << " " << c;
    }
  }
}

}  // namespace
}  // namespace h2mc::test
