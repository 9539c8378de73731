// SPDX-License-Identifier: MIT
// Parts of a scene that stand elsewhere: in other files, on top with an id; and what colours may be.
#include <gtest/gtest.h>

#include "render/image/image_io.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

const Bsdf& bsdfOf(const Scene& scene, std::size_t shape) {
  const auto material = static_cast<std::size_t>(scene.shapes.at(shape).material);
  return scene.bsdfs.at(static_cast<std::size_t>(scene.materials.at(material).front));
}

std::string version(std::string scene, const std::string& to) {
  scene.replace(scene.find("0.6.0"), 5, to);
  return scene;
}

TEST(SceneIncludes, AreFoundBesideTheFileAndThenBesideTheScene) {
  const SceneFolder folder;
  const std::string sphere = "<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>";
  folder.write("inc/base.xml",
               "<scene version=\"2.0.0\"><include filename=\"inc/far.xml\"/>"
               "<include filename=\"near.xml\"/></scene>");
  folder.write("inc/far.xml", "<scene version=\"2.0.0\"><shape type=\"disk\"/></scene>");
  folder.write("inc/near.xml", "<scene version=\"2.0.0\"><shape type=\"cube\"/></scene>");
  folder.write("near.xml", "<scene version=\"2.0.0\"><shape type=\"nothing\"/></scene>");
  const Scene scene = folder.read(sceneWith("<include filename=\"inc/base.xml\"/>"));
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<Disk>(scene.shapes[0].geometry));
  EXPECT_TRUE(std::holds_alternative<TriangleMesh>(scene.shapes[1].geometry));
}

TEST(SceneReferences, LeadToPartsOnTop) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      "<scene version=\"3.0.0\"><rfilter type=\"box\" id=\"r\"/>"
      "<film type=\"hdrfilm\" id=\"f\"><integer name=\"width\" value=\"7\"/><integer "
      "name=\"height\" value=\"5\"/><ref id=\"r\"/></film>"
      "<sampler type=\"independent\" id=\"s\"><integer name=\"sample_count\" "
      "value=\"9\"/></sampler>"
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><ref id=\"f\"/><ref "
      "id=\"s\"/>"
      "</sensor><emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" value=\"3\"/></emitter>"
      "<shape type=\"sphere\"><ref id=\"lamp\"/></shape></scene>");
  EXPECT_EQ(scene.film.width, 7);
  EXPECT_EQ(scene.film.height, 5);
  EXPECT_EQ(scene.film.filter.kind, Filter::Kind::kBox);
  EXPECT_EQ(scene.samplesPerPixel, 9);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.shapes[0].light, 0);
}

TEST(SceneReferences, PartsThatNothingRefersToAreLeftOut) {
  const Scene scene = SceneFolder().read(
      sceneWith("<sampler type=\"independent\"/><film type=\"hdrfilm\"/><rfilter type=\"box\"/>"));
  int leftOut = 0;
  for (const std::string& note : scene.notes)
    leftOut += note.rfind("left out: nothing refers", 0) == 0;
  EXPECT_EQ(leftOut, 3);
}

TEST(SceneSpectra, WithATypeAreTextures) {
  const SceneFolder folder;
  Image image(2, 1);
  image.at(0, 0) = Rgbf(0.25f);
  image.at(1, 0) = Rgbf(0.75f);
  writeImage(folder.path() + "t.exr", image);
  const Scene scene = folder.read(version(
      sceneWith(
          "<shape type=\"sphere\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
          "type=\"bitmap\"><string name=\"filename\" value=\"t.exr\"/></spectrum></bsdf></shape>"
          "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"><float "
          "name=\"scale\" value=\"2\"/></spectrum></emitter>"),
      "2.0.0"));
  const auto& diffuse = std::get<Diffuse>(bsdfOf(scene, 0));
  EXPECT_TRUE(std::holds_alternative<BitmapTexture>(*diffuse.reflectance));
  EXPECT_NEAR(average(*diffuse.reflectance).x, 0.5f, 1e-6f);
  EXPECT_EQ(std::get<ConstantLight>(scene.lights[0]).radiance, Rgbf(2));
}

TEST(SceneSpectra, AChannelOfABitmapAlone) {
  const SceneFolder folder;
  Image image(1, 1);
  image.at(0, 0) = Rgbf(0.1f, 0.2f, 0.3f);
  writeImage(folder.path() + "t.exr", image);
  const auto shape = [](const std::string& channel) {
    return sceneWith(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" "
        "type=\"bitmap\"><string name=\"filename\" value=\"t.exr\"/><string "
        "name=\"channel\" value=\"" +
        channel + "\"/></texture></bsdf></shape>");
  };
  const Scene scene = folder.read(shape("g"));
  const Rgbf c = average(*std::get<Diffuse>(bsdfOf(scene, 0)).reflectance);
  EXPECT_EQ(c, Rgbf(0.2f));
  const std::string message = folder.error(shape("a"));
  EXPECT_NE(message.find("it has no channel \"a\"; there are R, G, B"), std::string::npos)
      << message;
}

TEST(SceneSpectra, MeasuredIndicesMayDipBelowZero) {
  const auto metal = [](const char* eta) {
    return sceneWith("<shape type=\"sphere\"><bsdf type=\"conductor\"><rgb name=\"eta\" value=\"" +
                     std::string(eta) + "\"/><rgb name=\"k\" value=\"1, 2, 3\"/></bsdf></shape>");
  };
  const Scene scene = SceneFolder().read(metal("-0.05, 4, 4"));
  EXPECT_EQ(std::get<Conductor>(bsdfOf(scene, 0)).index.eta.x,
            std::get<Conductor>(bsdfOf(SceneFolder().read(metal("0.05, 4, 4")), 0)).index.eta.x);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("\"eta\" of bsdf \"conductor\" has a negative channel"),
            std::string::npos);
}

TEST(SceneLights, TheMessageNamesTheLampThatWasDropped) {
  const SceneFolder folder;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  const std::string message = folder.error(
      "<scene version=\"0.6.0\">" + std::string(kCamera) + kSphere +
      "<shape type=\"obj\"><string name=\"filename\" value=\"flat.obj\"/><emitter type=\"area\"/>"
      "</shape></scene>");
  EXPECT_NE(message.find("the scene has no light"), std::string::npos) << message;
  EXPECT_NE(message.find("flat.obj\" has no area, so its emitter emits nothing"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace h2mc::testing
