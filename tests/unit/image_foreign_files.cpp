// SPDX-License-Identifier: MIT
// A picture is read from the file that was named and from no other.
#include <gtest/gtest.h>

#include <filesystem>

#include "render/image/image_io.h"
#include "scene_files.h"

namespace h2mc {
namespace {

class ForeignFiles : public ::testing::Test {
 protected:
  std::string errorOf(const std::string& name) {
    try {
      readImage(folder_.path() + name);
    } catch (const ImageError& e) {
      return e.what();
    }
    return "";
  }
  testing::SceneFolder folder_;
};

// FFmpeg, by way of OpenImageIO, takes these for movies and shows the picture that they name.
TEST_F(ForeignFiles, PlaylistsAreNoPictures) {
  writeImage(folder_.path() + "other.png", Image(4, 4));
  for (const char* ending : {"mov", "avi", "mp4", "m4v", "mpg", "png", "exr", "txt", ""}) {
    const std::string name = std::string("list") + (*ending ? "." : "") + ending;
    folder_.write(name, "ffconcat version 1.0\nfile other.png\nduration 1\n");
    EXPECT_NE(errorOf(name).find(name), std::string::npos) << name;
    folder_.write(name,
                  "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nother.png\n#EXT-X-ENDLIST\n");
    EXPECT_NE(errorOf(name).find(name), std::string::npos) << name;
  }
  EXPECT_NE(errorOf("list.mov").find("none of the formats"), std::string::npos);
}

// The library has a reader that makes pictures out of their names.
TEST_F(ForeignFiles, NamesAreNoPictures) {
  folder_.write("black.null", "");
  EXPECT_NE(errorOf("black.null").find("none of the formats"), std::string::npos);
}

TEST_F(ForeignFiles, ContentCountsWhereTheEndingIsWrong) {
  Image image(3, 2);
  image.at(1, 1) = Rgbf(0.5f);
  for (const char* format : {"png", "exr", "hdr"}) {
    writeImage(folder_.path() + "picture." + format, image);
    for (const char* name : {"picture", "picture.mov", "picture.jpg", "picture.unknown"}) {
      std::filesystem::copy_file(folder_.path() + "picture." + format, folder_.path() + name,
                                 std::filesystem::copy_options::overwrite_existing);
      EXPECT_EQ(readImage(folder_.path() + name).width, 3) << format << " as " << name;
    }
  }
}

}  // namespace
}  // namespace h2mc
