// SPDX-License-Identifier: MIT
// Pictures with values that can be no light and no colour.
#include <gtest/gtest.h>

#include <limits>

#include "render/image/image_io.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class SceneTexels : public ::testing::Test {
 protected:
  // A picture of 4 x 3 ones with this at column 2 of row 1, as the scene's texture and as its environment.
  void picture(const Rgbf& bad) {
    Image image(4, 3);
    for (Rgbf& pixel : image.pixels) pixel = Rgbf(1);
    image.at(2, 1) = bad;
    writeImage(folder_.path() + "a.exr", image);
  }
  static std::string texture(const std::string& inside = "") {
    return sceneWith(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" "
        "type=\"bitmap\">"
        "<string name=\"filename\" value=\"a.exr\"/>" +
        inside + "</texture></bsdf></shape>");
  }
  static std::string environment() {
    return sceneWith(
        "<emitter type=\"envmap\"><string name=\"filename\" value=\"a.exr\"/></emitter>");
  }

  SceneFolder folder_;
};

TEST_F(SceneTexels, ThatAreNotFiniteAreNamed) {
  for (const std::string& scene :
       {texture(), environment(), modern(texture()), modern(environment())})
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      picture({1, bad, 1});
      const std::string message = folder_.error(scene);
      EXPECT_NE(message.find("\"a.exr\": 1 pixel is not finite; pixel (2, 1) is (1, "),
                std::string::npos)
          << message;
      EXPECT_NE(message.find("with --permissive they are 0"), std::string::npos) << message;
      const Scene read = folder_.read(scene, strictness(Strictness::kPermissive));
      ASSERT_EQ(read.warnings.size(), 1u);
      EXPECT_NE(read.warnings[0].find("warning: "), std::string::npos) << read.warnings[0];
    }
}

TEST_F(SceneTexels, ThatAreNegativeAreNoColours) {
  picture({1, -0.25f, 1});
  for (const std::string& scene : {texture(), environment()}) {
    const std::string message = folder_.error(modern(scene));
    EXPECT_NE(message.find("1 pixel is negative; pixel (2, 1) is (1, -0.25, 1)"), std::string::npos)
        << message;
    EXPECT_EQ(folder_.read(scene).warnings.size(), 1u);
    EXPECT_EQ(folder_.read(modern(scene), strictness(Strictness::kPermissive)).warnings.size(), 1u);
  }
}

TEST_F(SceneTexels, OfHeightsMayBeNegative) {
  picture({1, -0.25f, 1});
  const std::string bitmap =
      "<texture type=\"bitmap\"><string name=\"filename\" value=\"a.exr\"/></texture>";
  for (const std::string& heights : {bitmap, "<texture type=\"scale\">" + bitmap + "</texture>"})
    EXPECT_TRUE(folder_
                    .read(modern(sceneWith("<shape type=\"sphere\"><bsdf type=\"bumpmap\">" +
                                           heights + "<bsdf type=\"diffuse\"/></bsdf></shape>")))
                    .warnings.empty());
}

TEST_F(SceneTexels, TakenAsZeroAreZero) {
  picture({1, -0.25f, kNan});
  const Scene scene = folder_.read(texture(), strictness(Strictness::kPermissive));
  bool found = false;
  for (const Bsdf& bsdf : scene.bsdfs)
    if (const auto* diffuse = std::get_if<Diffuse>(&bsdf))
      if (const auto* bitmap = std::get_if<BitmapTexture>(diffuse->reflectance.get())) {
        EXPECT_EQ(bitmap->image->at(2, 1), Rgbf(1, 0, 0));
        EXPECT_EQ(bitmap->image->at(1, 1), Rgbf(1));
        found = true;
      }
  EXPECT_TRUE(found);
}

TEST_F(SceneTexels, GoodOnesPass) {
  picture(Rgbf(1));
  EXPECT_TRUE(folder_.read(modern(texture())).warnings.empty());
  EXPECT_TRUE(folder_.read(modern(environment())).warnings.empty());
}

}  // namespace
}  // namespace h2mc::testing
