// SPDX-License-Identifier: MIT
// Image files: what is written comes back, and a file is there whole or not at all.
#include "render/image/image_io.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

// A folder of the test's own.
class ImageIo : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("h2mc_image_io_" + std::string(info->name()) + "_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  int fileCount() const {
    int n = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++n;
    return n;
  }

  fs::path folder_;
};

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = Rgbf((x + 0.5f) / width, (y + 0.25f) / height, 0.125f * (x + y) / width);
  return image;
}

TEST_F(ImageIo, ExrIsExact) {
  Image image = gradient(13, 7);
  image.at(3, 2) = Rgbf(1e-30f, 12345.678f, -2.5f);  // float, not half
  writeImage(path("a.exr"), image);
  const Image back = readImage(path("a.exr"));
  ASSERT_EQ(back.width, 13);
  ASSERT_EQ(back.height, 7);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    EXPECT_EQ(back.pixels[i], image.pixels[i]) << i;
}

TEST_F(ImageIo, ExrKeepsAttributes) {
  const ImageAttributes attributes{{"scene", std::string("a \"quoted\" name.xml")},
                                   {"meanLuminance", 0.1},
                                   {"threads", 3},
                                   {"aNameThatIsLongerThanThirtyOneCharacters", std::string("")}};
  writeImage(path("a.exr"), gradient(4, 4), attributes);
  EXPECT_EQ(readAttributes(path("a.exr")), attributes);
}

// A part of a larger picture with layers of one and of three channels beside it.
TEST_F(ImageIo, ExrWithLayers) {
  const Image image = gradient(5, 3);
  Layer depth = makeLayer(LayerKind::kDepth, image.pixels.size());
  for (std::size_t i = 0; i < depth.values.size(); ++i) depth.values[i] = static_cast<float>(i);
  const Layer normal = makeLayer(LayerKind::kNormal, gradient(5, 3));
  const std::vector<Layer> layers{depth, normal};
  const FilmWindow window{7, 2, 20, 10};
  writeLayeredImage(path("a.exr"), image, {{{"threads", 3}}, layers, window});

  const ExrHeader header = readExrHeader(path("a.exr"));
  EXPECT_EQ(header.width, 5);
  EXPECT_EQ(header.height, 3);
  EXPECT_EQ(header.window, window);
  EXPECT_EQ(header.attributes, (ImageAttributes{{"threads", 3}}));
  EXPECT_EQ(layersOf(header), (std::vector<std::string>{"depth", "normal"}));
  const Image back = readImage(path("a.exr"));
  ASSERT_EQ(back.width, 5);
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(readImage(path("a.exr"), 0, "depth.Z").at(2, 1), Rgbf(7));

  const std::vector<Layer> both = readLayers(path("a.exr"), {"normal", "depth", "none"});
  ASSERT_EQ(both.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(both[i].name, layers[i].name);
    EXPECT_EQ(both[i].channels, layers[i].channels);
    EXPECT_EQ(both[i].values, layers[i].values);
  }
  EXPECT_EQ(pictureOf(both[1], 5, 3).pixels, image.pixels);
  // By the alphabet in the file, as pictures have them in memory.
  const Layer albedo = makeLayer(LayerKind::kAlbedo, image);
  writeLayeredImage(path("b.exr"), image, {{}, std::span(&albedo, 1), {}});
  const std::vector<Layer> color = readLayers(path("b.exr"), {"albedo"});
  EXPECT_EQ(color.at(0).channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(color.at(0).values, albedo.values);
  EXPECT_FALSE(readExrHeader(path("b.exr")).window.isPart());
  // Other formats have the picture alone.
  writeLayeredImage(path("c.png"), image, {{}, std::span(&albedo, 1), window});
  EXPECT_EQ(readImage(path("c.png")).width, 5);
}

TEST_F(ImageIo, ExrHeaderAlone) {
  writeImage(path("a.exr"), gradient(5, 3), {{"threads", 3}});
  const ExrHeader header = readExrHeader(path("a.exr"));
  EXPECT_EQ(header.width, 5);
  EXPECT_EQ(header.height, 3);
  EXPECT_EQ(header.channels, (std::vector<std::string>{"B", "G", "R"}));
  EXPECT_EQ(header.attributes, (ImageAttributes{{"threads", 3}}));
  EXPECT_THROW(readExrHeader(path("missing.exr")), ImageError);
}

TEST_F(ImageIo, SameImageSameBytes) {
  const auto bytes = [&](const std::string& name) {
    std::ifstream stream(path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  for (const std::string ending : {".exr", ".png", ".hdr"}) {
    writeImage(path("a" + ending), gradient(40, 30), {{"threads", 3}});
    writeImage(path("b" + ending), gradient(40, 30), {{"threads", 3}});
    EXPECT_FALSE(bytes("a" + ending).empty());
    EXPECT_EQ(bytes("a" + ending), bytes("b" + ending));
  }
}

TEST_F(ImageIo, PngIsSrgb) {
  Image image(4, 1);
  image.at(0, 0) = Rgbf(0, 0.2158605f, 1);  // 128 / 255 decoded
  image.at(1, 0) = Rgbf(-1, 5, std::numeric_limits<float>::quiet_NaN());
  image.at(2, 0) = Rgbf(0.001f, std::numeric_limits<float>::infinity(), 0);
  writeImage(path("a.png"), image);

  const Image raw = readImage(path("a.png"), 1);
  EXPECT_NEAR(raw.at(0, 0).x * 255, 0, 1e-3);
  EXPECT_NEAR(raw.at(0, 0).y * 255, 128, 1e-3);
  EXPECT_NEAR(raw.at(0, 0).z * 255, 255, 1e-3);
  EXPECT_NEAR(raw.at(1, 0).x, 0, 1e-6);
  EXPECT_NEAR(raw.at(1, 0).y, 1, 1e-6);
  EXPECT_NEAR(raw.at(1, 0).z, 0, 1e-6);
  EXPECT_NEAR(raw.at(2, 0).x * 255, 3, 1e-3);  // 12.92 * 0.255 = 3.29
  EXPECT_NEAR(raw.at(2, 0).y, 1, 1e-6);

  EXPECT_NEAR(readImage(path("a.png")).at(0, 0).y, 0.2158605f, 1e-5);
  EXPECT_NEAR(readImage(path("a.png"), -1).at(0, 0).y, 0.2158605f, 1e-5);
  EXPECT_NEAR(readImage(path("a.png"), 2).at(0, 0).y, std::pow(128 / 255.f, 2.f), 1e-5);
}

TEST_F(ImageIo, HdrIsCloseToTheImage) {
  const Image image = gradient(20, 10);
  writeImage(path("a.hdr"), image);
  const Image back = readImage(path("a.hdr"));
  ASSERT_EQ(back.pixels.size(), image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[i][c], image.pixels[i][c], 0.01f);
}

TEST_F(ImageIo, EndingsInCapitals) {
  writeImage(path("a.PNG"), gradient(3, 3));
  EXPECT_EQ(readImage(path("a.PNG")).width, 3);
}

TEST_F(ImageIo, ReplacesAFileAndLeavesNothingElse) {
  writeImage(path("a.exr"), gradient(3, 3));
  writeImage(path("a.exr"), gradient(5, 5));
  EXPECT_EQ(readImage(path("a.exr")).width, 5);
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(ImageIo, WritesThroughALink) {
  writeImage(path("a.exr"), gradient(3, 3));
  fs::create_symlink("a.exr", path("link.exr"));
  writeImage(path("link.exr"), gradient(6, 6));
  EXPECT_TRUE(fs::is_symlink(path("link.exr")));
  EXPECT_EQ(readImage(path("a.exr")).width, 6);
}

TEST_F(ImageIo, FindsOutWhatCannotBeWritten) {
  EXPECT_THROW(checkWritable(path("a.tga")), ImageError);
  EXPECT_THROW(checkWritable(path("a")), ImageError);
  EXPECT_THROW(checkWritable(""), ImageError);
  EXPECT_THROW(checkWritable(path("nowhere/a.exr")), ImageError);
  EXPECT_THROW(checkWritable(path(std::string(400, 'a') + ".exr")), ImageError);
  fs::create_directory(path("folder.exr"));
  EXPECT_THROW(checkWritable(path("folder.exr")), ImageError);
  fs::remove(path("folder.exr"));
  ASSERT_EQ(mkfifo(path("pipe.exr").c_str(), 0600), 0);
  EXPECT_THROW(checkWritable(path("pipe.exr")), ImageError);
  fs::remove(path("pipe.exr"));

  EXPECT_NO_THROW(checkWritable(path("a.exr")));
  EXPECT_EQ(fileCount(), 0);
}

TEST_F(ImageIo, RespectsWriteProtection) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(checkWritable(path("a.exr")), ImageError);
}

TEST_F(ImageIo, AFailedWriteLeavesTheOldFile) {
  writeImage(path("a.exr"), gradient(3, 3));
  EXPECT_THROW(writeImage(path("a.exr"), Image()), ImageError);
  // An attribute of this name has another type in every file: OpenEXR refuses.
  EXPECT_THROW(writeImage(path("a.exr"), gradient(4, 4), {{"channels", 1}}), ImageError);
  EXPECT_EQ(readImage(path("a.exr")).width, 3);
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(ImageIo, AnAbandonedFileGoesAway) {
  {
    AtomicFile file(path("a.txt"));
    EXPECT_EQ(fileCount(), 1);
    EXPECT_FALSE(fs::exists(path("a.txt")));
  }
  EXPECT_EQ(fileCount(), 0);
  writeTextAtomically(path("a.txt"), "text");
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(ImageIo, ASignalHandlerCanCleanUp) {
  AtomicFile file(path("a.txt"));
  removeTemporaryFiles();
  EXPECT_EQ(fileCount(), 0);
}

TEST_F(ImageIo, SaysWhatCannotBeRead) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      readImage(path);
    } catch (const ImageError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(path("none.exr")).find("none.exr"), std::string::npos);
  EXPECT_NE(message(path("none.exr")).find("no such file"), std::string::npos);
  EXPECT_NE(message(folder_.string()).find("it is a folder"), std::string::npos);
  for (const std::string name : {"bad.exr", "bad.png", "bad.hdr", "bad.jpg", "bad.xyz"}) {
    std::ofstream(path(name)) << "not a picture";
    EXPECT_NE(message(path(name)).find(name), std::string::npos) << name;
  }
  EXPECT_THROW(readAttributes(path("bad.exr")), ImageError);
}

// A grey picture of one pixel, 128 of 255; the chunk between header and data.
std::string png(const std::string& chunk) {
  const auto bytes = [](std::initializer_list<int> list) {
    std::string text;
    for (const int b : list) text += static_cast<char>(b);
    return text;
  };
  return bytes({0x89, 'P', 'N', 'G', 13, 10, 26, 10}) +
         bytes({0, 0, 0, 13, 'I', 'H', 'D', 'R', 0,    0,    0,    1,   0,
                0, 0, 1, 8,  0,   0,   0,   0,   0x3A, 0x7E, 0x9B, 0x55}) +
         chunk + bytes({0,    0,    0,    10,   'I',  'D',  'A',  'T',  0x78, 0x9C, 0x63,
                        0x68, 0x00, 0x00, 0x00, 0x82, 0x00, 0x81, 0x77, 0xCD, 0x72, 0xB6}) +
         bytes({0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82});
}

TEST_F(ImageIo, PngsGammaCounts) {
  const auto value = [&](const std::string& chunk) {
    std::ofstream(path("a.png"), std::ios::binary) << png(chunk);
    return readImage(path("a.png")).at(0, 0).y;
  };
  const auto gama = [](int a, int b, int c, std::initializer_list<int> check) {
    std::string text{0, 0, 0, 4, 'g', 'A', 'M', 'A', 0};
    for (const int x : {a, b, c}) text += static_cast<char>(x);
    for (const int x : check) text += static_cast<char>(x);
    return text;
  };
  const float linear = 128 / 255.f;
  EXPECT_NEAR(value(""), 0.21586f, 1e-4f);                                                // sRGB
  EXPECT_NEAR(value(gama(0x01, 0x86, 0xA0, {0x31, 0xE8, 0x96, 0x5F})), linear, 1e-6f);    // 1
  EXPECT_NEAR(value(gama(0x00, 0xB1, 0x8F, {0x0B, 0xFC, 0x61, 0x05})), 0.21586f, 1e-4f);  // 1/2.2
  // 1 / 1.8
  EXPECT_NEAR(value(gama(0x00, 0xD9, 0x04, {0xDC, 0xB2, 0xDA, 0x02})), std::pow(linear, 1.8f),
              1e-4f);
}

TEST_F(ImageIo, OneChannelAlone) {
  Image image(1, 1);
  image.at(0, 0) = Rgbf(0.1f, 0.2f, 0.3f);
  writeImage(path("a.exr"), image);
  EXPECT_EQ(readImage(path("a.exr"), 0, "b").at(0, 0), Rgbf(0.3f));
  EXPECT_EQ(readImage(path("a.exr"), 0, "G").at(0, 0), Rgbf(0.2f));
  EXPECT_THROW(readImage(path("a.exr"), 0, "a"), ImageError);
}

}  // namespace
}  // namespace h2mc
