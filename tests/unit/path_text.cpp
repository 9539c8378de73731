// SPDX-License-Identifier: MIT
#include "render/path/path_text.h"

#include <gtest/gtest.h>

#include "render/core/index.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

TEST(PathText, ComesBackToTheLastBit) {
  Random random(3, 1, 4);
  for (const Technique technique : {Technique{0, 2}, Technique{2, 1}, Technique{3, 4}}) {
    PrimarySample sample{};
    for (int i = 0; i < technique.dimension(); ++i) sample.u[at(i)] = random.uniform();
    for (int i = 0; i < technique.choices(); ++i) sample.choice[at(i)] = random.uniform();
    Technique technique2;
    PrimarySample sample2;
    EXPECT_EQ(parsePathText(pathText(technique, sample), technique2, sample2), "");
    EXPECT_EQ(technique2, technique);
    EXPECT_EQ(sample2.u, sample.u);
    EXPECT_EQ(sample2.choice, sample.choice);
  }
}

TEST(PathText, SaysWhatIsWrong) {
  Technique technique;
  PrimarySample sample;
  const auto wrong = [&](const std::string& text) {
    return parsePathText(text, technique, sample);
  };
  EXPECT_EQ(wrong("s=0 t=2 u=0.5,0x1p-2"), "");
  EXPECT_EQ(sample.u[1], 0.25f);
  EXPECT_NE(wrong("").find("s="), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2").find("u="), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2 v=3 u=0,0").find("v=3"), std::string::npos);
  EXPECT_NE(wrong("s=1 t=1 u=0,0").find("no technique"), std::string::npos);
  EXPECT_NE(wrong("s=x t=2 u=0,0").find("no technique"), std::string::npos);
  EXPECT_NE(wrong("s=40 t=2 u=0,0").find("no technique"), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2 u=0").find("2 coordinates"), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2 u=0,1").find("[0, 1)"), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2 u=0,nan").find("[0, 1)"), std::string::npos);
  EXPECT_NE(wrong("s=0 t=2 u=0,,0").find("[0, 1)"), std::string::npos);
  EXPECT_NE(wrong("s=2 t=2 u=0,0,0,0,0,0 choice=").find("1 choices"), std::string::npos);
}

}  // namespace
}  // namespace h2mc
