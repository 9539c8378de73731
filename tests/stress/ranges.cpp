// SPDX-License-Identifier: MIT
// Numbers at the ends of float's range: sizes, places, radiances, lengths, primary coordinates.
#include <gtest/gtest.h>

#include "stress_check.h"

namespace h2mc::test {
namespace {

// A glossy ball and a glass one, a point lamp beside the area lamp, and a wall.
std::string mixedScene() {
  return sceneText(
      camera("0, 1.5, 5", "0, 0.8, 0") + floorOf(diffuse(0.5)) + lamp() +
      shape("rectangle", "<scale value=\"4\"/><translate z=\"-2\"/>",
            "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.2\"/></bsdf>") +
      shape("sphere", "<scale value=\"0.6\"/><translate x=\"-0.8\" y=\"0.65\"/>",
            "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.2\"/></bsdf>") +
      "<shape type=\"sphere\"><point name=\"center\" x=\"0.8\" y=\"0.65\" z=\"0\"/><float "
      "name=\"radius\" value=\"0.6\"/><bsdf type=\"dielectric\"/></shape>\n"
      "<emitter type=\"point\"><point name=\"position\" x=\"-2\" y=\"2\" z=\"2\"/><rgb "
      "name=\"intensity\" value=\"3, 4, 5\"/></emitter>\n");
}

const StressFindings& unchanged() {
  static const StressFindings findings = [] {
    const testing::SceneFolder folder;
    return expectSound(sceneOf(folder, mixedScene()), "as it is");
  }();
  return findings;
}

// The picture is the same, up to rounding, since the random numbers are.
void expectSamePicture(const StressFindings& found, double factor, double tolerance) {
  const auto expectRatio = [&](const PictureComparison::Estimate& mean,
                               const PictureComparison::Estimate& own) {
    EXPECT_NEAR(mean.mean / own.mean / factor, 1, tolerance);
  };
  expectRatio(found.pictures.bdpt, unchanged().pictures.bdpt);
  expectRatio(found.pictures.h2mc, unchanged().pictures.h2mc);
}

TEST(Sizes, From1e4thTo1e6) {
  const testing::SceneFolder folder;
  for (const double scale : {1e-4, 1e-2, 1e3, 1e6}) {
    const Scene scene = changedScene(folder, mixedScene(), [&](SceneDocument& d) {
      EXPECT_GT(moveScene(d, scale, glm::dvec3(0)), 0);
    });
    expectSamePicture(expectSound(scene, "scale " + std::to_string(scale)), 1, 0.02);
  }
}

TEST(Places, A1e6Away) {
  const testing::SceneFolder folder;
  const Scene scene = changedScene(folder, mixedScene(), [](SceneDocument& d) {
    EXPECT_GT(moveScene(d, 1, glm::dvec3(1e6)), 0);
  });
  EXPECT_NEAR(scene.origin.x, 1e6, 1);
  const StressFindings found = expectSound(scene, "moved by 1e6");
  expectSamePicture(found, 1, 0.02);
  EXPECT_LT(found.hessian.median, 1e-5);
}

TEST(Radiances, From1e30thTo1e30) {
  const testing::SceneFolder folder;
  for (const double factor : {1e-30, 1e-10, 1e10, 1e30}) {
    const Scene scene = changedScene(
        folder, mixedScene(), [&](SceneDocument& d) { EXPECT_EQ(scaleRadiance(d, factor), 2); });
    char name[32];
    std::snprintf(name, sizeof name, "radiance times %g", factor);
    expectSamePicture(expectSound(scene, name), factor, 0.02);
  }
}

// A closed white room, in which paths of 32 edges still carry light.
TEST(Lengths, To32Edges) {
  const testing::SceneFolder folder;
  const std::string text = sceneText(
      camera("0, 0, 0.5", "0, 0, 0", 80) +
      shape("cube", "<scale value=\"1\"/>",
            "<boolean name=\"flipNormals\" value=\"true\"/>" + diffuse(0.9)) +
      shape("sphere", "<scale value=\"0.2\"/><translate y=\"0.6\"/>",
            "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.3\"/></bsdf>") +
      shape("rectangle",
            "<scale value=\"0.3\"/><rotate x=\"1\" angle=\"90\"/><translate x=\"0.4\" y=\"0.99\"/>",
            diffuse(0) + emitter("3")));
  StressSettings settings = quickStress();
  settings.maxLength = kMaxPathLength;
  settings.paths = 40;
  settings.samples = 4000;
  expectSound(sceneOf(folder, text), "32 edges", {.resolved = false}, settings);
}

class Borders : public ::testing::TestWithParam<CoordinatePlacement> {};

TEST_P(Borders, OfTheUnitCube) {
  const testing::SceneFolder folder;
  StressSettings settings = quickStress();
  settings.placement = GetParam();
  const std::string name = GetParam() == CoordinatePlacement::kZero ? "u = 0" : "u = 1 - 2^-24";
  expectSound(sceneOf(folder, mixedScene()), name, {}, settings);
  for (const char* bsdf :
       {"<bsdf type=\"phong\"/>", "<bsdf type=\"plastic\"/>", "<bsdf type=\"roughdielectric\"/>",
        "<bsdf type=\"mask\"><bsdf type=\"roughconductor\"><string name=\"distribution\" "
        "value=\"ggx\"/></bsdf></bsdf>"})
    expectSound(sceneOf(folder, ballScene(bsdf)), name, {}, settings);
  const std::string others = sceneText(
      camera("0, 1.5, 5", "0, 0.8, 0") + floorOf(diffuse(0.5)) +
      shape("sphere", "<translate y=\"3\"/><scale value=\"0.5\"/>", diffuse(0) + emitter("4")) +
      shape("disk", "<rotate x=\"1\" angle=\"90\"/><translate x=\"2\" y=\"3\"/>",
            diffuse(0) + emitter("4")) +
      "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.3\"/></emitter>\n"
      "<emitter type=\"spot\"><transform name=\"toWorld\"><lookat origin=\"-2, 3, 0\" target=\"0, "
      "0, 0\" up=\"0, 0, 1\"/></transform><rgb name=\"intensity\" value=\"9\"/></emitter>\n"
      "<emitter type=\"directional\"><vector name=\"direction\" x=\"1\" y=\"-1\" "
      "z=\"0\"/></emitter>\n");
  expectSound(sceneOf(folder, others), name, {}, settings);
}

INSTANTIATE_TEST_SUITE_P(Both, Borders,
                         ::testing::Values(CoordinatePlacement::kZero,
                                           CoordinatePlacement::kBelowOne),
                         [](const auto& info) {
                           return info.param == CoordinatePlacement::kZero ? "Zero" : "BelowOne";
                         });

}  // namespace
}  // namespace h2mc::test
