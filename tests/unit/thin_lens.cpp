// SPDX-License-Identifier: MIT
// The thin lens: its rays, and the aperture that they go through.
#include <gtest/gtest.h>

#include <cmath>

#include "render/camera/camera.h"
#include "render/core/random.h"
#include "scene_files.h"

namespace h2mc {
namespace {

constexpr float kRadius = 0.3f, kFocus = 4;

Camera lens() {
  Camera camera(glm::translate(Mat4(1), Vec3f(1, 2, 3)), 40, Camera::FovAxis::kX, 1.5f);
  camera.crop(0.2, 0.1, 0.9, 0.8);
  camera.focus(kRadius, kFocus);
  return camera;
}

TEST(ThinLens, RaysOfAFilmPointMeetInThePlaneOfFocus) {
  const Camera camera = lens();
  Random random(1, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const float filmX = random.uniform(), filmY = random.uniform();
    const auto meet = [&](const std::array<float, 2>& aperture) {
      const CameraPose<float> pose = camera.poseOf(0, aperture);
      const Vec3f direction = camera.direction(pose, filmX, filmY);
      return pose.position + direction * (kFocus / dot(pose.forward, direction));
    };
    const Vec3f centre = meet({0.5f, 0.5f}), other = meet({random.uniform(), random.uniform()});
    EXPECT_LT(glm::distance(centre, other), 1e-5f);
    EXPECT_NEAR(centre.z, 3 + kFocus, 1e-5f);
  }
}

TEST(ThinLens, ProjectsBackToTheFilm) {
  const Camera camera = lens();
  Random random(2, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const float filmX = random.uniform(), filmY = random.uniform();
    const CameraPose<float> pose = camera.poseOf(0, {random.uniform(), random.uniform()});
    float x = -1, y = -1;
    ASSERT_TRUE(camera.project(pose, camera.direction(pose, filmX, filmY) * 3.f, x, y));
    EXPECT_NEAR(x, filmX, 1e-5f);
    EXPECT_NEAR(y, filmY, 1e-5f);
  }
}

// The area of every ring and sector of the disk is that of what is mapped to it.
TEST(ThinLens, ApertureIsUniform) {
  const Camera camera = lens();
  constexpr int kSide = 400, kRings = 4, kSectors = 8;
  int counts[kRings][kSectors] = {};
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const CameraPose<float> pose = camera.poseOf(
          0, {(static_cast<float>(i) + 0.5f) / kSide, (static_cast<float>(k) + 0.5f) / kSide});
      const Vec3f d = (pose.position - Vec3f(1, 2, 3)) / kRadius;
      EXPECT_EQ(d.z, 0);
      const float square = dot(d, d), turn = std::atan2(d.y, d.x) / (2 * kPi) + 0.5f;
      ASSERT_LE(square, 1 + 1e-5f);
      const int ring = std::min(kRings - 1, static_cast<int>(square * kRings));
      ++counts[ring][std::min(kSectors - 1, static_cast<int>(turn * kSectors))];
    }
  for (const auto& ring : counts)
    for (const int count : ring)
      EXPECT_NEAR(count, kSide * kSide / double(kRings * kSectors), 0.03 * kSide * kSide / 32);
}

constexpr const char* kScene = R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="thinlens">LENS</sensor>
<emitter type="constant"/></scene>)";

Scene sceneWith(const std::string& lens) {
  testing::SceneFolder folder;
  std::string xml = kScene;
  return folder.read(xml.replace(xml.find("LENS"), 4, lens));
}

TEST(ThinLens, IsReadFromScenes) {
  const Camera camera =
      sceneWith(
          R"(<float name="apertureRadius" value="0.5"/><float name="focusDistance" value="7"/>)")
          .camera;
  EXPECT_EQ(camera.apertureRadius(), 0.5f);
  EXPECT_EQ(camera.focusDistance(), 7);
  const Scene far =
      sceneWith(R"(<float name="apertureRadius" value="1"/><float name="farClip" value="50"/>)");
  EXPECT_EQ(far.camera.focusDistance(), 50);
  const Scene pinhole = sceneWith(R"(<float name="apertureRadius" value="0"/>)");
  EXPECT_FALSE(pinhole.camera.hasAperture());
  EXPECT_EQ(pinhole.shared().count(), 0);
}

TEST(ThinLens, MistakesAreRefused) {
  EXPECT_THROW(sceneWith(""), SceneError);
  EXPECT_THROW(sceneWith(R"(<float name="apertureRadius" value="-1"/>)"), SceneError);
  EXPECT_THROW(sceneWith(R"(<float name="apertureRadius" value="1"/>
                            <float name="focusDistance" value="0"/>)"),
               SceneError);
}

}  // namespace
}  // namespace h2mc
