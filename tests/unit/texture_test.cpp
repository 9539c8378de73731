// SPDX-License-Identifier: MIT
#include "render/texture/texture.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "bsdf_properties.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

using namespace test;
using D = ad::Dual2<double, 2>;

BitmapTexture bitmap(int width, int height, std::vector<Rgbf> pixels) {
  auto image = std::make_shared<Image>(width, height);
  image->pixels = std::move(pixels);
  BitmapTexture t;
  t.image = image;
  return t;
}
BitmapTexture twoByTwo() { return bitmap(2, 2, {Rgbf(1), Rgbf(2), Rgbf(4), Rgbf(8)}); }

TEST(Texture, CheckerboardStartsWithColor0) {
  CheckerboardTexture t;
  t.color0 = Rgbf(1);
  t.color1 = Rgbf(0);
  const auto at = [&](float u, float v) { return t.evaluate(Vec2f(u, v)).x; };
  EXPECT_EQ(at(0.2f, 0.2f), 1);
  EXPECT_EQ(at(0.7f, 0.2f), 0);
  EXPECT_EQ(at(0.2f, 0.7f), 0);
  EXPECT_EQ(at(0.7f, 0.7f), 1);
  EXPECT_EQ(at(1.2f, 0.2f), 1);
  EXPECT_EQ(at(-0.2f, 0.2f), 1);  // fields are counted towards zero, as in Mitsuba 0.6
  EXPECT_EQ(at(-0.7f, 0.2f), 0);
  t.mapping = {{8, 8}, {0.5f, 0}};
  EXPECT_EQ(at(0, 0), 0);
  EXPECT_EQ(at(1 / 16.0f, 0), 1);
  EXPECT_EQ(t.average(), Rgbf(0.5f));
  EXPECT_EQ(t.maximum(), Rgbf(1));
}

TEST(Texture, BitmapHasItsFirstRowAtVZero) {
  BitmapTexture t = twoByTwo();
  const auto at = [&](float u, float v) { return t.evaluate(Vec2f(u, v)).x; };
  EXPECT_FLOAT_EQ(at(0.25f, 0.25f), 1);
  EXPECT_FLOAT_EQ(at(0.75f, 0.25f), 2);
  EXPECT_FLOAT_EQ(at(0.25f, 0.75f), 4);
  EXPECT_FLOAT_EQ(at(0.75f, 0.75f), 8);
  EXPECT_FLOAT_EQ(at(0.5f, 0.25f), 1.5f);
  EXPECT_FLOAT_EQ(at(0.5f, 0.5f), 15 / 4.0f);
  t.nearest = true;
  EXPECT_FLOAT_EQ(at(0.45f, 0.45f), 1);
  EXPECT_FLOAT_EQ(at(0.55f, 0.45f), 2);
  EXPECT_EQ(t.average(), Rgbf(15 / 4.0f));
  EXPECT_EQ(t.maximum(), Rgbf(8));
}

TEST(Texture, BitmapWraps) {
  BitmapTexture t = twoByTwo();
  t.nearest = true;
  const auto at = [&](WrapMode mode, float u, float v) {
    t.wrapU = t.wrapV = mode;
    return t.evaluate(Vec2f(u, v)).x;
  };
  EXPECT_EQ(at(WrapMode::kRepeat, -0.25f, 0.25f), 2);
  EXPECT_EQ(at(WrapMode::kRepeat, 7.25f, -3.25f), 4);
  EXPECT_EQ(at(WrapMode::kMirror, -0.25f, 0.25f), 1);
  EXPECT_EQ(at(WrapMode::kMirror, 1.25f, 0.25f), 2);
  EXPECT_EQ(at(WrapMode::kMirror, 1.75f, 0.25f), 1);
  EXPECT_EQ(at(WrapMode::kClamp, -3.0f, 9.0f), 4);
  EXPECT_EQ(at(WrapMode::kZero, 1.1f, 0.5f), 0);
  EXPECT_EQ(at(WrapMode::kOne, 0.5f, -0.1f), 1);
  t.nearest = false;
  EXPECT_FLOAT_EQ(at(WrapMode::kRepeat, 0, 0.25f), 1.5f);
  EXPECT_FLOAT_EQ(at(WrapMode::kClamp, 0, 0.25f), 1);
  // No coordinate is too much.
  for (const float x : {1e30f, -1e30f, INFINITY, NAN})
    EXPECT_TRUE(std::isfinite(at(WrapMode::kRepeat, x, 0.5f)));
}

TEST(Texture, DifferentiatesWithinATexel) {
  BitmapTexture t = twoByTwo();
  t.mapping = {{3, 0.5f}, {0.1f, 0.2f}};
  const double u = 0.21, v = 0.37, h = 1e-4;
  const auto at = [&](double x, double y) { return t.evaluate(Vec2<double>(x, y)).x; };
  const D d = t.evaluate(Vec2<D>(D::variable(u, 0), D::variable(v, 1))).x;
  EXPECT_NEAR(d.v, at(u, v), 1e-12);
  EXPECT_NEAR(d.gradient(0), (at(u + h, v) - at(u - h, v)) / (2 * h), 1e-6);
  EXPECT_NEAR(d.gradient(1), (at(u, v + h) - at(u, v - h)) / (2 * h), 1e-6);
  EXPECT_NEAR(
      d.hessian(0, 1),
      (at(u + h, v + h) - at(u + h, v - h) - at(u - h, v + h) + at(u - h, v - h)) / (4 * h * h),
      1e-5);
  EXPECT_EQ(d.hessian(0, 0), 0);
}

TEST(Texture, SlopesAreTheDerivatives) {
  BitmapTexture t = twoByTwo();
  t.mapping = {{3, 0.5f}, {0.1f, 0.2f}, {0.4f, -0.7f}};
  const Texture scaled =
      ProductTexture{constantTexture(Rgbf(0.5f, 2, 3)), std::make_shared<const Texture>(t)};
  const Texture squared =
      ProductTexture{std::make_shared<const Texture>(t), std::make_shared<const Texture>(t)};
  const double u = 0.21, v = 0.37;
  const Vec2<D> at(D::variable(u, 0), D::variable(v, 1));
  for (const Texture& texture : {Texture(t), scaled, squared}) {
    const Rgb<D> d = evaluate<D>(texture, at);
    const TextureSlope<D> slope = slopeOf<D>(texture, at);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(slope.value[c].v, d[c].v, 1e-12);
      EXPECT_NEAR(slope.du[c].v, d[c].gradient(0), 1e-12);
      EXPECT_NEAR(slope.dv[c].v, d[c].gradient(1), 1e-12);
      EXPECT_NEAR(slope.du[c].gradient(1), d[c].hessian(0, 1), 1e-12);
      EXPECT_NEAR(slope.dv[c].gradient(1), d[c].hessian(1, 1), 1e-12);
    }
  }
  t.nearest = true;
  EXPECT_EQ(slopeOf<float>(Texture(t), Vec2f(0.3f)).du, Rgbf(0));
  EXPECT_EQ(slopeOf<float>(Texture(CheckerboardTexture{}), Vec2f(0.3f)).dv, Rgbf(0));
}

TEST(Texture, ProductsMultiplyAverageAndMaximum) {
  const auto board =
      std::make_shared<const Texture>(CheckerboardTexture{Rgbf(0.8f), Rgbf(0.2f), {}});
  const ProductTexture scaled{constantTexture(Rgbf(0.5f, 1, 2)), board};
  EXPECT_EQ(scaled.evaluate<float>(Vec2f(0.1f)), Rgbf(0.4f, 0.8f, 1.6f));
  EXPECT_EQ(scaled.average(), Rgbf(0.25f, 0.5f, 1));
  EXPECT_EQ(scaled.maximum(), Rgbf(0.4f, 0.8f, 1.6f));
  // Of a texture with itself it is not the product of the averages.
  const ProductTexture twice{board, board};
  EXPECT_NEAR(twice.average().x, (0.64f + 0.04f) / 2, 1e-5);
  EXPECT_FLOAT_EQ(twice.maximum().x, 0.64f);
}

TEST(Texture, ModulateScalesConstantsAndOthersAlike) {
  const Texture constant = ConstantTexture{Rgbf(0.1f, 0.2f, 0.3f)}, picture = twoByTwo();
  const Vec2<D> uv(D::variable(0.6, 0), D::variable(0.3, 1));
  const D scale = uv.x * uv.y;
  EXPECT_NEAR(modulate<D>(constant, uv, scale).y.gradient(0), 0.2f * 0.3, 1e-9);
  const D product = evaluate<D>(picture, uv).z * scale;
  EXPECT_NEAR(modulate<D>(picture, uv, scale).z.gradient(1), product.gradient(1), 1e-12);
}

TEST(Texture, PluginsReadTheirParameters) {
  const auto make = [](const char* name, std::map<std::string, FakeProperties::Value> values) {
    const auto& plugin = pluginNamed(texturePlugins(), name);
    return plugin.create(FakeProperties(plugin.parameters, std::move(values)));
  };
  const auto board = std::get<CheckerboardTexture>(*make("checkerboard", {{"uscale", 3.0f}}));
  EXPECT_EQ(board.color0, Rgbf(0.4f));
  EXPECT_EQ(board.color1, Rgbf(0.2f));
  EXPECT_EQ(board.mapping.scale, Vec2f(3, 1));

  const auto path = (std::filesystem::temp_directory_path() / "h2mc_texture_test.exr").string();
  Image image(2, 1);
  image.at(0, 0) = Rgbf(0.25f);
  image.at(1, 0) = Rgbf(3);
  writeImage(path, image);
  const auto first = make("bitmap", {{"filename", path},
                                     {"uvscale", 100.0f},
                                     {"wrapMode", "clamp"},
                                     {"wrapModeV", "mirror"},
                                     {"filterType", "nearest"}});
  const auto second = make("bitmap", {{"filename", path}});
  std::filesystem::remove(path);
  const auto& a = std::get<BitmapTexture>(*first);
  const auto& b = std::get<BitmapTexture>(*second);
  EXPECT_EQ(a.image, b.image);  // read once
  EXPECT_EQ(a.image->at(1, 0), Rgbf(3));
  EXPECT_EQ(a.mapping.scale, Vec2f(100));
  EXPECT_EQ(a.wrapU, WrapMode::kClamp);
  EXPECT_EQ(a.wrapV, WrapMode::kMirror);
  EXPECT_TRUE(a.nearest);
  EXPECT_FALSE(b.nearest);
  EXPECT_EQ(b.wrapU, WrapMode::kRepeat);
  EXPECT_THROW(make("bitmap", {{"filename", path + ".missing"}}), SceneError);
}

}  // namespace
}  // namespace h2mc
