// SPDX-License-Identifier: MIT
// The orthographic camera.
#include <gtest/gtest.h>

#include "render/core/random.h"
#include "render/path/subpath.h"
#include "scene_files.h"

namespace h2mc {
namespace {

Scene sceneWith(const std::string& sensor) {
  testing::SceneFolder folder;
  return folder.read(
      R"(<scene version="0.6.0"><integrator type="path"/><sensor type="orthographic">)" + sensor +
      R"(</sensor><emitter type="constant"/></scene>)");
}

// Twice as wide as high, its film 6 wide, cropped to a part.
constexpr const char* kTilted = R"(<transform name="toWorld"><scale x="3" y="3"/>
<lookat origin="1, 2, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="400"/><integer name="height" value="200"/>
<integer name="cropOffsetX" value="40"/><integer name="cropOffsetY" value="20"/>
<integer name="cropWidth" value="300"/><integer name="cropHeight" value="100"/></film>)";

TEST(ParallelCamera, HasTheFilmThatTheScaleSays) {
  const Scene scene = sceneWith(kTilted);
  ASSERT_TRUE(scene.camera.isParallel());
  EXPECT_NEAR(scene.camera.filmArea(), 6 * 0.75 * 3 * 0.5, 1e-5);
  const CameraPose<float> pose = scene.camera.pose<float>();
  // The whole film's middle is the transform's origin.
  const Vec3f middle = scene.camera.origin(pose, (200.f - 40) / 300, (100.f - 20) / 100);
  EXPECT_LT(glm::distance(middle, Vec3f(1, 2, 3)), 1e-6f);
  const Vec3f corner = scene.camera.origin(pose, 0.f, 0.f) - middle;
  EXPECT_NEAR(dot(corner, pose.left), 3 * (1 - 2 * 0.1f), 1e-5f);
  EXPECT_NEAR(dot(corner, pose.up), 1.5 * (1 - 2 * 0.1f), 1e-5f);
}

TEST(ParallelCamera, ProjectsBackToTheFilm) {
  const Scene scene = sceneWith(kTilted);
  const CameraPose<float> pose = scene.camera.pose<float>();
  Random random(1, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const float filmX = random.uniform(), filmY = random.uniform();
    const PathRay<float> ray = startCamera<float>(scene, filmX, filmY);
    EXPECT_EQ(ray.direction, pose.forward);
    float x = -1, y = -1;
    const Vec3f seen = ray.origin + ray.direction * (5 * random.uniform());
    ASSERT_TRUE(scene.camera.project(pose, seen - pose.position, x, y));
    EXPECT_NEAR(x, filmX, 1e-5f);
    EXPECT_NEAR(y, filmY, 1e-5f);
    EXPECT_FALSE(scene.camera.project(pose, seen - ray.direction * 6.f - pose.position, x, y));
  }
}

TEST(ParallelCamera, HasNoFieldOfView) {
  testing::SceneFolder folder;
  EXPECT_THROW(folder.read(R"(<scene version="2.0.0"><integrator type="path"/>
<sensor type="orthographic"><float name="fov" value="40"/></sensor><emitter type="constant"/></scene>)"),
               SceneError);
}

}  // namespace
}  // namespace h2mc
