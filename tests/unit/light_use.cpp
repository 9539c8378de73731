// SPDX-License-Identifier: MIT
#include "render/path/light_use.h"

#include <gtest/gtest.h>

#include "scene_files.h"

namespace h2mc::testing {
namespace {

// A floor, a lamp above its middle, where the camera looks, and a second floor far away, which makes the
// scene large.
std::string lampOnAPlain(const std::string& more) {
  return "<scene version=\"0.6.0\">"
         "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><transform "
         "name=\"toWorld\">"
         "<lookat origin=\"0,3,-6\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
         "<film type=\"hdrfilm\"><integer name=\"width\" value=\"32\"/>"
         "<integer name=\"height\" value=\"24\"/></film></sensor>"
         "<shape type=\"rectangle\"><transform name=\"toWorld\"><rotate x=\"1\" angle=\"-90\"/>"
         "<scale value=\"500\"/></transform></shape>"
         "<shape type=\"rectangle\"><transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/>"
         "<translate y=\"2\"/></transform><emitter type=\"area\">"
         "<rgb name=\"radiance\" value=\"5\"/></emitter></shape>" +
         more + "</scene>";
}

TEST(LightUse, ALampIsNotStarvedByAnEnvironmentThatGrowsWithTheScene) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      lampOnAPlain("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.1\"/></emitter>"));
  ASSERT_EQ(scene.lights.size(), 2u);
  const int lamp = 1 - scene.environment;
  // By power it would be once in 10,000 samples.
  EXPECT_GT(scene.directPicker.probability(lamp), 0.4f);
  EXPECT_GT(scene.emissionPicker.probability(lamp), 0.2f);
  EXPECT_GT(scene.directPicker.probability(scene.environment), 0.05f);
}

TEST(LightUse, ALampThatNobodySeesIsSeldomPicked) {
  const SceneFolder folder;
  // Ten times as bright, below the floor.
  const Scene scene = folder.read(lampOnAPlain(
      "<shape type=\"rectangle\"><transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/>"
      "<translate y=\"-2\"/></transform><emitter type=\"area\">"
      "<rgb name=\"radiance\" value=\"50\"/></emitter></shape>"));
  ASSERT_EQ(scene.lights.size(), 2u);
  const int hidden = scene.shapes[2].light;
  ASSERT_GE(hidden, 0);
  EXPECT_LT(scene.directPicker.probability(hidden), 0.1f);
  // It emits, so it may be seen by ways that were not found.
  EXPECT_GT(scene.directPicker.probability(hidden), 0.05f);
  EXPECT_GT(scene.emissionPicker.probability(hidden), 0.4f);
}

}  // namespace
}  // namespace h2mc::testing
