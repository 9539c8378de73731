// SPDX-License-Identifier: MIT
// Numbers, transforms and spectra as they are written in scene files.
#include <gtest/gtest.h>

#include "render/scene/spectrum.h"
#include "render/scene/suggestion.h"
#include "render/scene/transform_reader.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

Mat4 transform(const std::string& operations) {
  auto file = std::make_shared<SourceFile>();
  file->name = "test.xml";
  file->text = "<transform name=\"toWorld\">" + operations + "</transform>";
  std::vector<StrayText> strays;
  return readTransform(parseXml(file, strays));
}

void expectPoint(const Mat4& m, const Vec3f& p, const Vec3f& expected, float tolerance = 1e-5f) {
  const Vec3f q = Vec3f(m * glm::vec4(p.x, p.y, p.z, 1));
  EXPECT_NEAR(q.x, expected.x, tolerance);
  EXPECT_NEAR(q.y, expected.y, tolerance);
  EXPECT_NEAR(q.z, expected.z, tolerance);
}

TEST(SceneTransform, EachOperation) {
  const Vec3f p(1, 2, 3);
  expectPoint(transform(""), p, p);
  expectPoint(transform("<translate x=\"1\" z=\"-2\"/>"), p, {2, 2, 1});
  expectPoint(transform("<translate value=\"1 1 1\"/>"), p, {2, 3, 4});
  expectPoint(transform("<scale value=\"2\"/>"), p, {2, 4, 6});
  expectPoint(transform("<scale x=\"2\" y=\"3\"/>"), p, {2, 6, 3});  // z stays
  expectPoint(transform("<scale value=\"2, 3, 4\"/>"), p, {2, 6, 12});
  expectPoint(transform("<rotate z=\"1\" angle=\"90\"/>"), p, {-2, 1, 3});
  expectPoint(transform("<rotate x=\"5\" angle=\"90\"/>"), p, {1, -3, 2});
  expectPoint(transform("<matrix value=\"1 0 0 10, 0 2 0 20, 0 0 3 30, 0 0 0 1\"/>"), p,
              {11, 24, 39});
  expectPoint(transform("<matrix value=\"0 1 0 1 0 0 0 0 1\"/>"), p, {2, 1, 3});
}

TEST(SceneTransform, OperationsApplyInTheirOrder) {
  const Vec3f p(1, 0, 0);
  expectPoint(transform("<translate x=\"1\"/><scale value=\"2\"/>"), p, {4, 0, 0});
  expectPoint(transform("<scale value=\"2\"/><translate x=\"1\"/>"), p, {3, 0, 0});
  expectPoint(transform("<rotate z=\"1\" angle=\"90\"/><translate x=\"1\"/><scale y=\"3\"/>"), p,
              {1, 3, 0});
}

TEST(SceneTransform, LookAtIsMitsubas) {
  const Mat4 m = transform("<lookat origin=\"1,2,3\" target=\"1,2,13\" up=\"0,1,0\"/>");
  expectPoint(m, {0, 0, 0}, {1, 2, 3});
  expectPoint(m, {0, 0, 1}, {1, 2, 4});  // looks along z
  expectPoint(m, {0, 1, 0}, {1, 3, 3});
  expectPoint(m, {1, 0, 0}, {2, 2, 3});
  EXPECT_GT(glm::determinant(glm::mat3(m)), 0.99f);
  // No up: any frame around the direction.
  const Mat4 free = transform("<lookAt origin=\"0,0,0\" target=\"0,5,0\"/>");
  expectPoint(free, {0, 0, 1}, {0, 1, 0});
  EXPECT_NEAR(glm::determinant(glm::mat3(free)), 1, 1e-5f);
}

TEST(SceneValues, BooleansInAnyCase) {
  EXPECT_TRUE(parseBoolean(" TRUE "));
  EXPECT_FALSE(parseBoolean("False"));
  EXPECT_THROW(parseBoolean("yes"), ValueError);
}

TEST(SceneValues, Numbers) {
  EXPECT_EQ(parseNumber(" .5 "), 0.5);
  EXPECT_EQ(parseNumber("+2"), 2);
  EXPECT_EQ(parseNumber("-1e-3"), -1e-3);
  EXPECT_EQ(parseNumber("1e-999"), 0);
  for (const char* bad :
       {"", " ", "x", "1x", "--1", "+-1", "0x10", "1,5", "nan", "-inf", "1e999", "1e39"})
    EXPECT_THROW(parseNumber(bad), ValueError) << bad;
  EXPECT_EQ(parseInteger("-12"), -12);
  EXPECT_EQ(parseInteger("+12"), 12);
  for (const char* bad : {"", "1.0", "1e3", "99999999999999999999", "a"})
    EXPECT_THROW(parseInteger(bad), ValueError) << bad;
  EXPECT_EQ(parseNumbers(" 1,2 ,\n3\t4 ,").size(), 4u);
  EXPECT_TRUE(parseNumbers(" , ").empty());
}

TEST(SceneSpectrum, ConstantHasUnitLuminance) {
  const Rgbf c = parseSpectrum("300:1, 900:1");
  EXPECT_NEAR(luminance(c), 1, 2e-3f);
  // The equal-energy white point in Rec. 709.
  EXPECT_NEAR(c.x, 1.205f, 0.01f);
  EXPECT_NEAR(c.y, 0.948f, 0.01f);
  EXPECT_NEAR(c.z, 0.909f, 0.015f);
}

TEST(SceneSpectrum, BandsHaveTheirColors) {
  const Rgbf red = parseSpectrum("610:0 620:1 680:1 690:0");
  EXPECT_GT(red.x, 5 * red.y);
  const Rgbf green = parseSpectrum("510:0 520:1 560:1 570:0");
  EXPECT_GT(green.y, green.x);
  EXPECT_GT(green.y, green.z);
  const Rgbf blue = parseSpectrum("430:0 440:1 460:1 470:0");
  EXPECT_GT(blue.z, 4 * blue.x);
  EXPECT_GE(std::min({red.z, green.z, blue.y}), 0);
  EXPECT_THROW(parseSpectrum("400:1, 300:1"), ValueError);
  EXPECT_THROW(parseSpectrum("400:1, 500"), ValueError);
  EXPECT_THROW(parseSpectrum("400:-1, 500:1"), ValueError);
}

TEST(SceneSpectrum, BlackBodiesRedden) {
  const Rgbf warm = blackbodyToRgb(2700), cold = blackbodyToRgb(10000);
  EXPECT_GT(warm.x, 2 * warm.z);
  EXPECT_GT(cold.z, cold.x);
  // Near 6,500 K white is white.
  const Rgbf white = blackbodyToRgb(6500);
  EXPECT_NEAR(white.x / white.y, 1, 0.08f);
  EXPECT_NEAR(white.z / white.y, 1, 0.08f);
}

TEST(Suggestion, FindsTypingMistakes) {
  const Names names = {"alpha", "distribution", "intIOR", "specularReflectance"};
  EXPECT_EQ(closestName("alhpa", names), "alpha");
  EXPECT_EQ(closestName("int_ior", names), "intIOR");
  EXPECT_EQ(closestName("specularReflectence", names), "specularReflectance");
  EXPECT_EQ(closestName("xyz", names), "");
  EXPECT_EQ(closestName("", names), "");
  EXPECT_EQ(closestName(std::string(100000, 'a'), names), "");
  EXPECT_EQ(snakeCase("specularReflectance"), "specular_reflectance");
  EXPECT_EQ(snakeCase("intIOR"), "int_ior");
  EXPECT_EQ(snakeCase("fov"), "fov");
}

}  // namespace
}  // namespace h2mc
