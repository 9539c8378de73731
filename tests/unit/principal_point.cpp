// SPDX-License-Identifier: MIT
// A film beside the axis sees what a window of a larger film sees.
#include <gtest/gtest.h>

#include "render/core/random.h"
#include "scene_files.h"

namespace h2mc {
namespace {

std::string film(const std::string& inside) {
  return R"(<scene version="3.0.0"><integrator type="path"/><sensor type="SENSOR">
<transform name="to_world"><lookat origin="1, 2, 5" target="0, 0.5, 0" up="0, 1, 0"/></transform>)" +
         inside + R"(</sensor><emitter type="constant"/></scene>)";
}
std::string of(std::string scene, const std::string& sensor) {
  return scene.replace(scene.find("SENSOR"), 6, sensor);
}

// Of 40 x 30 pixels, shifted by 10 pixels to the right and 6 upwards; and of 120 x 90 with the same pixels.
const std::string kShifted = R"(<float name="fov" value="30"/>
<float name="principal_point_offset_x" value="0.25"/><float name="principal_point_offset_y" value="-0.2"/>
<film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/></film>)";
std::string windowOfLarger() {
  const double fov = glm::degrees(2 * std::atan(3 * std::tan(glm::radians(15.0))));
  return "<float name=\"fov\" value=\"" + std::to_string(fov) + R"("/><film type="hdrfilm">
<integer name="width" value="120"/><integer name="height" value="90"/>
<integer name="crop_width" value="40"/><integer name="crop_height" value="30"/>
<integer name="crop_offset_x" value="50"/><integer name="crop_offset_y" value="24"/></film>)";
}

TEST(PrincipalPoint, IsAWindowOfALargerFilm) {
  testing::SceneFolder folder;
  const std::string lens =
      R"(<float name="aperture_radius" value="0.2"/><float name="focus_distance" value="4"/>)";
  for (const bool thin : {false, true}) {
    const std::string sensor = thin ? "thinlens" : "perspective", more = thin ? lens : "";
    const Scene shifted = folder.read(of(film(kShifted + more), sensor));
    const Scene window = folder.read(of(film(windowOfLarger() + more), sensor));
    EXPECT_NEAR(shifted.camera.filmArea(), window.camera.filmArea(), 1e-6);
    Random random(1, 2, 3);
    for (int i = 0; i < 100; ++i) {
      const std::array<float, 2> aperture{random.uniform(), random.uniform()};
      const CameraPose<float> a = shifted.camera.poseOf(0, aperture);
      const CameraPose<float> b = window.camera.poseOf(0, aperture);
      const float filmX = random.uniform(), filmY = random.uniform();
      const Vec3f direction = shifted.camera.direction(a, filmX, filmY);
      EXPECT_LT(glm::distance(direction, window.camera.direction(b, filmX, filmY)), 1e-6f);
      EXPECT_LT(glm::distance(a.position, b.position), 1e-6f);
      float x = -1, y = -1;
      ASSERT_TRUE(shifted.camera.project(a, direction * 3.f, x, y));
      EXPECT_NEAR(x, filmX, 1e-5f);
      EXPECT_NEAR(y, filmY, 1e-5f);
    }
  }
}

// Of a window of a shifted film the offset is in widths of the whole film.
TEST(PrincipalPoint, GoesByTheWholeFilm) {
  testing::SceneFolder folder;
  std::string cropped = kShifted;
  cropped.replace(cropped.find("</film>"), 7, R"(<integer name="crop_width" value="20"/>
<integer name="crop_height" value="15"/><integer name="crop_offset_x" value="10"/>
<integer name="crop_offset_y" value="5"/></film>)");
  const Camera whole = folder.read(of(film(kShifted), "perspective")).camera;
  const Camera part = folder.read(of(film(cropped), "perspective")).camera;
  EXPECT_LT(glm::distance(part.direction(0.f, 0.f), whole.direction(0.25f, 5 / 30.f)), 1e-6f);
  EXPECT_LT(glm::distance(part.direction(1.f, 1.f), whole.direction(0.75f, 20 / 30.f)), 1e-6f);
  // To the right is where x goes.
  const Camera straight = folder
                              .read(of(film(R"(<float name="fov" value="30"/><film type="hdrfilm">
<integer name="width" value="40"/><integer name="height" value="30"/></film>)"),
                                       "perspective"))
                              .camera;
  EXPECT_LT(glm::distance(whole.direction(0.25f, 0.7f), straight.direction(0.5f, 0.5f)), 1e-6f);
}

TEST(PrincipalPoint, IsRefusedWhereItIsAbsurd) {
  testing::SceneFolder folder;
  EXPECT_NE(folder
                .error(of(film(R"(<float name="principal_point_offset_x" value="1000"/>)"),
                          "perspective"))
                .find("from -100 to 100"),
            std::string::npos);
}

}  // namespace
}  // namespace h2mc
