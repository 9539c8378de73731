// SPDX-License-Identifier: MIT
// What a scene has too much of, or nobody knows: a warning, an error, or left out, by the file's version
// and by what the user asks for. And all that is wrong is said at once.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/core/index.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// The parameter that a file of version 0.x may have too much of.
const std::string kLeftover =
    sceneWith("<shape type=\"sphere\">\n  <boolean name=\"faceNormals\" value=\"false\"/></shape>");

TEST(SceneLeftovers, AreWarningsInOldFiles) {
  const SceneFolder folder;
  const Scene scene = folder.read(kLeftover);
  EXPECT_EQ(scene.shapes.size(), 2u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  std::string text = scene.warnings[0];
  text.erase(text.find(folder.path()), folder.path().size());
  EXPECT_EQ(text,
            "scene.xml:3:18: warning: unknown parameter \"faceNormals\" of shape \"sphere\"\n"
            "    <boolean name=\"faceNormals\" value=\"false\"/></shape>\n"
            "                   ^\n"
            "expected a parameter that it has; did you mean \"flipNormals\"? available: center, "
            "radius, toWorld, flipNormals");
}

TEST(SceneLeftovers, AreErrorsInNewFiles) {
  const SceneFolder folder;
  EXPECT_NE(folder.error(modern(kLeftover)).find("error: unknown parameter \"faceNormals\""),
            std::string::npos);
  // A file that does not say its version is a new one.
  std::string text = kLeftover;
  text.erase(text.find(" version"), std::string(" version=\"0.6.0\"").size());
  EXPECT_FALSE(folder.error(text).empty());
}

TEST(SceneLeftovers, StrictAndPermissive) {
  const SceneFolder folder;
  EXPECT_NE(folder.error(kLeftover, strictness(Strictness::kStrict)).find("error: unknown"),
            std::string::npos);
  const Scene scene = folder.read(modern(kLeftover), strictness(Strictness::kPermissive));
  EXPECT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(SceneLeftovers, OfWhatIsGivenTwiceTheLastCounts) {
  const Scene scene =
      SceneFolder().read(sceneWith("<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/>"
                                   "<float name=\"radius\" value=\"3\"/></shape>"));
  EXPECT_FLOAT_EQ(std::get<Sphere>(scene.shapes[0].geometry).radius, 3);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("given twice"), std::string::npos);
  EXPECT_NE(scene.warnings[0].find("first at"), std::string::npos);
  const Scene integrator = SceneFolder().read(
      sceneWith("<integrator type=\"path\"><integer name=\"maxDepth\" value=\"3\"/><integer "
                "name=\"maxDepth\" value=\"4\"/></integrator>"));
  EXPECT_EQ(integrator.integrator.integer("maxDepth"), 4);
  EXPECT_EQ(integrator.warnings.size(), 1u);
}

TEST(SceneLeftovers, TextBetweenElements) {
  const SceneFolder folder;
  const std::string scene = sceneWith("<shape type=\"disk\"/> -->");
  const Scene read = folder.read(scene);
  EXPECT_EQ(read.shapes.size(), 2u);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find(":2:22: warning: text inside <scene>"), std::string::npos)
      << read.warnings[0];
  EXPECT_FALSE(folder.error(modern(scene)).empty());
}

// It is known and changes the picture: not just a note.
TEST(SceneLeftovers, SmoothingByAngleIsWarnedOf) {
  const SceneFolder folder;
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene =
      folder.read(sceneWith("<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/><float "
                            "name=\"maxSmoothAngle\" value=\"30\"/></shape>"));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("\"maxSmoothAngle\" of shape \"obj\" is not used"),
            std::string::npos);
}

TEST(SceneLeftovers, EachIsSaidOnce) {
  const std::string bsdf =
      "<bsdf type=\"conductor\" id=\"a\"><float name=\"alpha\" value=\"0.1\"/></bsdf>";
  const std::string use = "<shape type=\"sphere\"><ref id=\"a\"/></shape>";
  EXPECT_EQ(SceneFolder().read(sceneWith(bsdf + use + use)).warnings.size(), 1u);
}

// No leftover: it was meant to be seen.
TEST(SceneLeftovers, ATextureOfAnUnknownNameIsAnError) {
  const std::string scene = sceneWith(
      "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" "
      "name=\"reflectence\"/></bsdf></shape>");
  const std::string message = SceneFolder().error(scene);
  EXPECT_NE(message.find("unknown parameter \"reflectence\""), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean \"reflectance\"?"), std::string::npos) << message;
}

TEST(SceneLeftovers, WhatNothingRefersToDoesNoHarm) {
  const SceneFolder folder;
  const std::string scene = sceneWith(
      "<bsdf type=\"velvet\" id=\"x\"/>"
      "<bsdf type=\"diffuse\" id=\"y\"><rgb name=\"color\" value=\"1\"/></bsdf>");
  for (const std::string& text : {scene, modern(scene)}) {
    const Scene read = folder.read(text);
    ASSERT_EQ(read.warnings.size(), 2u);
    EXPECT_NE(read.warnings[0].find("warning: unknown bsdf \"velvet\""), std::string::npos);
    EXPECT_NE(read.warnings[1].find("warning: unknown parameter \"color\""), std::string::npos);
  }
  EXPECT_FALSE(folder.error(scene, strictness(Strictness::kStrict)).empty());
}

TEST(SceneLeftovers, MediaAreRefusedOrLeftOut) {
  const SceneFolder folder;
  const std::string scene = sceneWith(
      "<medium type=\"homogeneous\" id=\"fog\"/>"
      "<shape type=\"sphere\"><ref name=\"interior\" id=\"fog\"/></shape>"
      "<shape type=\"sphere\"><ref name=\"interior\" id=\"fog\"/><bsdf type=\"diffuse\"/></shape>");
  EXPECT_NE(folder.error(scene).find("--permissive"), std::string::npos);
  const Scene read = folder.read(scene, strictness(Strictness::kPermissive));
  EXPECT_EQ(read.shapes.size(), 2u);  // the border of nothing is not there
  EXPECT_EQ(read.warnings.size(), 2u);
  // One that nothing is filled with.
  EXPECT_TRUE(folder.read(sceneWith("<medium type=\"homogeneous\" id=\"fog\"/>")).warnings.empty());
}

TEST(SceneProblems, AreAllSaidAtOnce) {
  const SceneFolder folder;
  const std::string message = folder.error(sceneWith(
      "<include filename=\"missing.xml\"/>\n"
      "<shape type=\"ball\"/>\n"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"big\"/><point name=\"center\" "
      "value=\"1\"/>\n"
      "<bsdf type=\"velvet\"/><emitter type=\"aria\"/></shape>\n"
      "<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>\n"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"$size\"/></shape>\n"
      "<emitter type=\"sunset\"/>\n"
      "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"deep\"/><integer "
      "name=\"rrDepth\" value=\"deep\"/></integrator>"));
  for (const char* part :
       {"scene.xml:2:20: error: no such file: \"missing.xml\"",
        "scene.xml:3:14: error: unknown shape", "\"big\" is not a number",
        "scene.xml:4:", "expected 3 numbers", "unknown bsdf \"velvet\"", "unknown emitter \"aria\"",
        "no such file: \"none.obj\"", "undefined name \"$size\"", "unknown emitter \"sunset\"",
        "scene.xml:9:"})
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nin: " << message;
  EXPECT_EQ(count(message, ": error: "), 11u) << message;
}

TEST(SceneProblems, OneThatManyMeetIsSaidOnce) {
  const std::string bsdf = "<bsdf type=\"velvet\" id=\"a\"/>";
  const std::string use = "<shape type=\"sphere\"><ref id=\"a\"/></shape>";
  const std::string message = SceneFolder().error(sceneWith(bsdf + use + use + use));
  EXPECT_EQ(count(message, "error:"), 1u) << message;
}

TEST(SceneProblems, WhatFollowsFromAMissingIncludeIsNotSaid) {
  const std::string message = SceneFolder().error(
      sceneWith("<include filename=\"materials.xml\"/>"
                "<shape type=\"sphere\"><ref id=\"from the include\"/></shape>"));
  EXPECT_EQ(count(message, "error:"), 1u) << message;
}

}  // namespace
}  // namespace h2mc::testing
