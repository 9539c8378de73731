// SPDX-License-Identifier: MIT
// Scene files that are made to exhaust the reader: stack, time and the patience of who reads the messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "render/scene/problems.h"
#include "render/scene/suggestion.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

std::string repeated(int count, const std::function<std::string(const std::string& number)>& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text(std::to_string(i));
  return all;
}

std::string errorOf(const std::string& text) { return SceneFolder().error(text); }

std::ptrdiff_t count(const std::string& text, const std::string& word) {
  std::ptrdiff_t n = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) ++n;
  return n;
}

// Each element refers to the next one; what is made inside each other must not overflow the stack.
TEST(HostileScene, ChainsOfReferences) {
  const auto next = [](const std::string& number) { return std::to_string(std::stoi(number) + 1); };
  const auto chain = [&](int length, const std::string& open, const std::string& close,
                         const std::string& last, const std::string& use) {
    return sceneWith(
        repeated(length,
                 [&](const std::string& i) {
                   return open + " id=\"c" + i + "\"><ref " +
                          (last.find("texture") != std::string::npos ? "name=\"value\" " : "") +
                          "id=\"c" + next(i) + "\"/>" + close;
                 }) +
        last + " id=\"c" + std::to_string(length) + "\"/><shape type=\"sphere\">" + use +
        "</shape>");
  };
  const auto textures = [&](int length) {
    return chain(length, "<texture type=\"scale\"", "</texture>", "<texture type=\"checkerboard\"",
                 "<bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"c0\"/></bsdf>");
  };
  const auto materials = [&](const char* type, int length) {
    return chain(length, std::string("<bsdf type=\"") + type + "\"", "</bsdf>",
                 "<bsdf type=\"diffuse\"", "<ref id=\"c0\"/>");
  };
  EXPECT_EQ(errorOf(textures(40)), "");
  for (const int length : {100, 20000}) {
    EXPECT_NE(errorOf(textures(length)).find("deep"), std::string::npos) << length;
    for (const char* type : {"twosided", "mask", "bumpmap", "normalmap", "coating"})
      EXPECT_NE(errorOf(materials(type, length)), "") << type << length;
  }
}

TEST(HostileScene, ErrorsWithoutEnd) {
  const int many = 3000;
  const std::string unknown = sceneWith(repeated(many, [](const std::string& i) {
    return "<shape type=\"sphere\"><ref id=\"unknown" + i + "\"/></shape>";
  }));
  const std::string undefined = sceneWith(repeated(many, [](const std::string& i) {
    return "<shape type=\"sphere\"><float name=\"radius\" value=\"$undefined" + i + "\"/></shape>";
  }));
  for (const std::string& scene : {unknown, undefined}) {
    const std::string error = errorOf(scene);
    EXPECT_EQ(count(error, ": error: "), static_cast<std::ptrdiff_t>(Problems::kMost));
    EXPECT_EQ(count(error, "there is more"), 1);
  }
}

TEST(HostileScene, WarningsWithoutEnd) {
  const int more = 7, many = static_cast<int>(Problems::kMostWarnings) + more;
  const Scene scene = SceneFolder().read(sceneWith(repeated(many, [](const std::string& i) {
    return "<shape type=\"sphere\"><float name=\"unknown" + i + "\" value=\"1\"/></shape>";
  })));
  ASSERT_EQ(scene.warnings.size(), Problems::kMostWarnings + 1);
  EXPECT_EQ(scene.warnings.back(), "and 7 more warnings");
}

TEST(HostileScene, AttributesWithoutEnd) {
  const auto scene = [](int attributes) {
    return sceneWith(
        "<shape type=\"sphere\" " +
        repeated(attributes, [](const std::string& i) { return "a" + i + "=\"1\" "; }) + "/>");
  };
  EXPECT_EQ(errorOf(scene(20)), "");
  EXPECT_NE(errorOf(scene(100)).find("more than 64 attributes"), std::string::npos);
}

// Found by a fuzzer: rays without a direction, at which Embree aborts.
TEST(HostileScene, CamerasWithoutSize) {
  const auto scene = [](const std::string& transform) {
    std::string text = sceneWith("");
    return text.insert(text.find("<film"),
                       "<transform name=\"toWorld\">" + transform + "</transform>");
  };
  for (const char* fine :
       {"<scale value=\"1e-3\"/>", "<scale value=\"1e3\"/>", "<scale x=\"-1\"/>"})
    EXPECT_EQ(errorOf(scene(fine)), "") << fine;
  for (const char* nothing :
       {"<scale value=\"1e-45\"/>", "<scale value=\"1e-25\"/>", "<scale value=\"1e25\"/>",
        "<scale value=\"0\"/>", "<scale z=\"0\"/>", "<scale y=\"1e-30\"/>"})
    EXPECT_NE(errorOf(scene(nothing)), "") << nothing;
}

// A name is compared with those alone that are as long, give or take what makes a typing mistake.
TEST(HostileScene, SuggestionsStayAsTheyWere) {
  EXPECT_EQ(closestName("alhpa", {"a", "alpha", "alphabetical"}), "alpha");
  EXPECT_EQ(closestName("reflectanc", {"reflectance", "transmittance"}), "reflectance");
  EXPECT_EQ(closestName("abc", {"abcde"}), "");
  EXPECT_EQ(closestName("abcdef", {"abcdefgh", "bcdef"}), "bcdef");
  EXPECT_EQ(closestName("alpha", Names(200000, "alpha")), "");
}

}  // namespace
}  // namespace h2mc::testing
