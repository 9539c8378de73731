// SPDX-License-Identifier: MIT
// Scene files that are not in UTF-8.
#include <gtest/gtest.h>

#include "render/scene/text_encoding.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

TEST(SceneEncodings, BecomeUtf8) {
  const std::string utf8 =
      "<a b=\"\xC3\xA9\xF0\x9F\x98\x80\"/>";  // e with acute, a face beyond 16 bits
  EXPECT_EQ(toUtf8(utf8), utf8);
  EXPECT_EQ(toUtf8("\xEF\xBB\xBF" + utf8), utf8);
  const char16_t units[] = u"<a b=\"\u00E9\U0001F600\"/>";
  std::string little, big;
  for (std::size_t i = 0; units[i]; ++i) {
    const char low = static_cast<char>(units[i] & 0xFF), high = static_cast<char>(units[i] >> 8);
    little += {low, high};
    big += {high, low};
  }
  EXPECT_EQ(toUtf8(little), utf8);
  EXPECT_EQ(toUtf8(big), utf8);
  EXPECT_EQ(toUtf8("\xFF\xFE" + little), utf8);
  EXPECT_EQ(toUtf8("\xFE\xFF" + big), utf8);
  EXPECT_EQ(toUtf8("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a b=\"\xE9\"/>"),
            "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a b=\"\xC3\xA9\"/>");
  EXPECT_EQ(toUtf8("<a b=\"\xE9\"/>"), "<a b=\"\xC3\xA9\"/>");  // undeclared, and no UTF-8
  EXPECT_EQ(toUtf8(""), "");
}

TEST(SceneEncodings, ASceneInUtf16IsRead) {
  const std::string text = "<?xml version=\"1.0\" encoding=\"utf-16\"?>" + sceneWith("");
  std::string wide = "\xFF\xFE";
  for (const char c : text) wide += {c, '\0'};
  EXPECT_EQ(SceneFolder().read(wide).shapes.size(), 1u);
}

}  // namespace
}  // namespace h2mc::testing
