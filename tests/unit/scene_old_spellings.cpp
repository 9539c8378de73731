// SPDX-License-Identifier: MIT
// Scenes of Mitsuba before 0.4.
#include <gtest/gtest.h>

#include <cmath>

#include "scene_files.h"

namespace h2mc::testing {
namespace {

const Bsdf& bsdfOf(const Scene& scene, std::size_t shape) {
  const auto material = static_cast<std::size_t>(scene.shapes.at(shape).material);
  return scene.bsdfs.at(static_cast<std::size_t>(scene.materials.at(material).front));
}

TEST(SceneOldSpellings, OfMitsubaBeforeItsFourthVersion) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      "<scene version=\"0.2.0\"><camera type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
      "<boolean name=\"mapSmallerSide\" value=\"true\"/>"
      "<transform name=\"toWorld\"><lookAt ox=\"1\" oy=\"2\" oz=\"3\" tx=\"1\" ty=\"2\" tz=\"0\" "
      "ux=\"0\" uy=\"1\" uz=\"0\"/></transform>"
      "<film type=\"exrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" "
      "value=\"4\"/><boolean name=\"alpha\" value=\"false\"/></film></camera>"
      "<shape type=\"sphere\"><boolean name=\"inverted\" value=\"true\"/><bsdf type=\"roughmetal\">"
      "<float name=\"alphaB\" value=\"0.3\"/></bsdf><luminaire type=\"area\"><rgb "
      "name=\"intensity\" value=\"5\"/></luminaire></shape>"
      "<shape type=\"sphere\"><bsdf type=\"lambertian\"><texture type=\"checkerboard\" "
      "name=\"reflectance\"><spectrum name=\"brightColor\" value=\"0.9\"/><spectrum "
      "name=\"darkColor\" value=\"0.1\"/></texture></bsdf></shape>"
      "<shape type=\"sphere\"><bsdf type=\"phong\"><float name=\"diffuseAmount\" value=\"0.5\"/>"
      "<rgb name=\"diffuseReflectance\" value=\"0.4, 0.6, 0.8\"/></bsdf></shape></scene>");
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_TRUE(std::get<Sphere>(scene.shapes[0].geometry).flipNormals);
  EXPECT_FLOAT_EQ(std::get<RoughConductor>(bsdfOf(scene, 0)).facets.alpha, 0.3f);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_FLOAT_EQ(
      std::get<CheckerboardTexture>(*std::get<Diffuse>(bsdfOf(scene, 1)).reflectance).color0.x,
      0.9f);
  const Rgbf diffuse = average(*std::get<Phong>(bsdfOf(scene, 2)).diffuse);
  EXPECT_NEAR(diffuse.x, 0.2f, 1e-6f);
  EXPECT_NEAR(diffuse.z, 0.4f, 1e-6f);
  // The lookAt of then and the camera of then both mirror: what is to its right is to the right.
  EXPECT_GT(scene.camera.direction<float>(0.99f, 0.5f).x, 0.1f);
  // fov along the height, which is smaller.
  const Vec3f top = scene.camera.direction<float>(0.5f, 0.f);
  EXPECT_NEAR(std::acos(dot(top, scene.camera.forward())) * 180 / std::numbers::pi_v<float>, 20,
              1e-3f);
}

TEST(SceneOldSpellings, CamerasHadTheOtherHand) {
  const SceneFolder folder;
  const std::string body = std::string(kLight) + kSphere;
  const auto right = [&](const std::string& element, const std::string& number) {
    const Scene scene = folder.read("<scene version=\"" + number + "\"><" + element +
                                    " type=\"perspective\"><float name=\"fov\" value=\"40\"/></" +
                                    element + ">" + body + "</scene>");
    return scene.camera.direction<float>(0.99f, 0.5f).x;
  };
  EXPECT_LT(right("sensor", "0.6.0"), 0);  // it looks along +z
  EXPECT_GT(right("camera", "0.3.0"), 0);
}

}  // namespace
}  // namespace h2mc::testing
