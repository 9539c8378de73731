// SPDX-License-Identifier: MIT
// What camera rays meet first, where it is known.
#include "render/integrator/features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene_files.h"

namespace h2mc {
namespace {

const std::vector<LayerKind> kAll{LayerKind::kAlbedo,   LayerKind::kNormal, LayerKind::kDepth,
                                  LayerKind::kPosition, LayerKind::kTime,   LayerKind::kId};

// A wall of which the camera, 4 units before it and off its axis, sees the half on the left of the picture.
struct Wall {
  std::string bsdf, sensor = "perspective", parameters = "", film = "", more = "";
  std::string text() const {
    return R"(<scene version="0.6.0"><sensor type=")" + sensor + R"(">)" + parameters + R"(
  <transform name="toWorld"><lookat origin="1, 2, 4" target="1, 2, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>)" +
           film + R"(</film></sensor><emitter type="constant"/>
  <shape type="sphere"><point name="center" x="50" y="0" z="80"/></shape>
  <shape type="rectangle"><transform name="toWorld"><scale value="100"/><translate x="-99"/></transform>)" +
           bsdf + "</shape>" + more + "</scene>";
  }
};
constexpr const char* kRed =
    R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.3, 0.1"/></bsdf>)";

class Features : public ::testing::Test {
 protected:
  std::vector<Layer> render(const std::string& text, int threads = 1, int samples = 16) {
    scene_ = folder_.read(text);
    FeatureRequest request;
    request.layers = kAll;
    request.samplesPerPixel = samples;
    request.seed = 3;
    request.threads = threads;
    return renderFeatures(scene_, request);
  }
  // Channel c of the layer of this kind at a pixel.
  float at(const std::vector<Layer>& layers, LayerKind kind, int x, int y, int c = 0) const {
    for (const Layer& layer : layers)
      if (layer.name == layerName(kind).name)
        return layer
            .values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(scene_.film.width) +
                     static_cast<std::size_t>(x)) *
                        layer.channels.size() +
                    static_cast<std::size_t>(c)];
    throw std::runtime_error("no such layer");
  }

  testing::SceneFolder folder_;
  Scene scene_;
};

// To the digits of float, whatever the rays: means are exact where there is one value.
TEST_F(Features, OfAWall) {
  const auto layers = render(Wall{kRed}.text());
  ASSERT_EQ(layers.size(), kAll.size());
  for (int y = 1; y < 11; ++y) {
    for (int x = 0; x < 5; ++x) {
      const float albedo[] = {0.6f, 0.3f, 0.1f}, normal[] = {0, 0, 1};
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(at(layers, LayerKind::kAlbedo, x, y, c), albedo[c], 1e-5);
        EXPECT_NEAR(at(layers, LayerKind::kNormal, x, y, c), normal[c], 1e-5);
      }
      EXPECT_NEAR(at(layers, LayerKind::kDepth, x, y), 4, 1e-4);
      EXPECT_NEAR(at(layers, LayerKind::kPosition, x, y, 2), 0, 1e-4);
      EXPECT_EQ(at(layers, LayerKind::kId, x, y), 2);
      EXPECT_EQ(at(layers, LayerKind::kTime, x, y), 0);
    }
    for (int x = 11; x < 16; ++x) {  // nothing
      EXPECT_EQ(at(layers, LayerKind::kAlbedo, x, y), 0);
      EXPECT_EQ(at(layers, LayerKind::kNormal, x, y, 2), 0);
      EXPECT_EQ(at(layers, LayerKind::kDepth, x, y), 1e10f);
      EXPECT_EQ(at(layers, LayerKind::kPosition, x, y, 2), 0);
      EXPECT_EQ(at(layers, LayerKind::kId, x, y), 0);
    }
  }
}

// A pixel's place is that of its centre, where the filter is whole: positions are spread evenly over it. Means of eight
// pixels each; half a pixel would be seen.
TEST_F(Features, PositionsAreThoseOfPixels) {
  const auto layers = render(Wall{kRed}.text(), 2, 64);
  double left = 0, right = 0, below = 0;
  for (int y = 2; y < 10; ++y) {
    left += at(layers, LayerKind::kPosition, 2, y, 0) / 8;
    right += at(layers, LayerKind::kPosition, 5, y, 0) / 8;
  }
  for (int x = 2; x < 6; ++x) below += at(layers, LayerKind::kPosition, x, 9, 1) / 4;
  const double step = (right - left) / 3;
  EXPECT_NEAR(right, 1 + (5.5 - 8) * step, 0.15 * step);
  EXPECT_NEAR(below, 2 - (9.5 - 6) * step, 0.15 * step);
}

// A pixel of which the wall covers a half has half its albedo, and its whole depth.
TEST_F(Features, OfAnEdge) {
  const std::string box = R"(<rfilter type="box"/>)";
  const auto layers = render(Wall{.bsdf = kRed, .film = box}.text(), 1, 64);
  double least = 1, most = 0;
  for (int y = 0; y < 12; ++y) {
    const double half =
        at(layers, LayerKind::kAlbedo, 8, y) / 0.6 + at(layers, LayerKind::kAlbedo, 7, y) / 0.6;
    least = std::min(least, half);
    most = std::max(most, half);
    for (int x = 7; x < 9; ++x)
      if (at(layers, LayerKind::kAlbedo, x, y) > 0) {
        EXPECT_NEAR(at(layers, LayerKind::kDepth, x, y), 4, 1e-4);
      }
  }
  EXPECT_NEAR(least, 1, 0.05);
  EXPECT_NEAR(most, 1, 0.05);
}

// Parallel rays, a lens and a filter with negative lobes make no difference to a wall across the axis.
TEST_F(Features, OfOtherCameras) {
  const std::string lens =
      R"(<float name="apertureRadius" value="0.3"/><float name="focusDistance" value="3"/>)";
  for (const std::string sensor : {"orthographic", "thinlens"}) {
    SCOPED_TRACE(sensor);
    const Wall wall{.bsdf = kRed,
                    .sensor = sensor,
                    .parameters = sensor == "thinlens" ? lens : "",
                    .film = R"(<rfilter type="mitchell"/>)"};
    const auto layers = render(wall.text());
    for (int y = 3; y < 9; ++y)
      for (int x = 0; x < 5; ++x) {
        EXPECT_NEAR(at(layers, LayerKind::kAlbedo, x, y), 0.6, 1e-4);
        EXPECT_NEAR(at(layers, LayerKind::kDepth, x, y), 4, 1e-3);
        EXPECT_NEAR(at(layers, LayerKind::kNormal, x, y, 2), 1, 1e-4);
      }
  }
}

// What a surface scatters of white light: all of it where nothing is absorbed, by reflection and refraction; by a
// conductor its reflectance; and what is behind where it lets light pass.
TEST_F(Features, Albedo) {
  const auto albedo = [&](const std::string& bsdf, const std::string& more = "") {
    const auto layers = render(Wall{.bsdf = bsdf, .more = more}.text(), 2, 64);
    double sum = 0;
    for (int y = 2; y < 10; ++y)
      for (int x = 0; x < 5; ++x) sum += at(layers, LayerKind::kAlbedo, x, y);
    return sum / 40;
  };
  EXPECT_NEAR(albedo(R"(<bsdf type="dielectric"/>)"), 1, 1e-4);
  EXPECT_NEAR(albedo(R"(<bsdf type="thindielectric"/>)"), 1, 1e-4);
  // What microfacets lose by shadowing is little at this roughness.
  EXPECT_NEAR(albedo(R"(<bsdf type="roughdielectric"><float name="alpha" value="0.05"/></bsdf>)"),
              1, 0.02);
  EXPECT_NEAR(albedo(R"(<bsdf type="roughconductor"><float name="alpha" value="0.05"/>
    <string name="material" value="none"/></bsdf>)"),
              1, 0.02);
  const std::string behind =
      R"(<shape type="rectangle"><transform name="toWorld"><scale value="100"/>
    <translate z="-1"/></transform><bsdf type="diffuse"><spectrum name="reflectance" value="0.2"/></bsdf></shape>)";
  EXPECT_NEAR(albedo(std::string(R"(<bsdf type="mask"><float name="opacity" value="0.25"/>)") +
                         kRed + "</bsdf>",
                     behind),
              0.25 * 0.6 + 0.75 * 0.2, 0.01);
  EXPECT_NEAR(albedo(R"(<bsdf type="null"/>)", behind), 0.2, 1e-5);
}

// A shape that crosses the picture while the shutter is open is seen when it is there; the sky before and after is
// nothing that could be seen.
TEST_F(Features, Time) {
  const std::string text = R"(<scene version="0.6.0"><sensor type="orthographic">
  <float name="shutterOpen" value="2"/><float name="shutterClose" value="4"/>
  <transform name="toWorld"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/><scale x="8" y="8"/></transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/><rfilter type="box"/></film>
  </sensor><emitter type="constant"/><shape type="rectangle"><animation name="toWorld">
  <transform time="2"><translate x="-4"/></transform><transform time="4"><translate x="4"/></transform></animation>
  </shape></scene>)";
  const auto layers = render(text, 2, 256);
  int seen = 0;
  for (int x = 0; x < 16; ++x) {
    const float time = at(layers, LayerKind::kTime, x, 8);
    if (at(layers, LayerKind::kDepth, x, 8) > 1e9f) continue;
    ++seen;
    // At place p, from p - 1 to p + 1 over the middle, at 4 units a unit of time.
    const double p = std::abs(at(layers, LayerKind::kPosition, x, 8, 0));
    if (p > 2.4) continue;
    EXPECT_NEAR(time, 3 + at(layers, LayerKind::kPosition, x, 8, 0) / 4, 0.04) << x;
  }
  EXPECT_GE(seen, 9);
}

TEST_F(Features, WhateverTheThreads) {
  const std::string text = Wall{.bsdf = kRed, .film = R"(<rfilter type="mitchell"/>)"}.text();
  const auto one = render(text, 1), three = render(text, 3);
  for (std::size_t i = 0; i < one.size(); ++i)
    EXPECT_EQ(one[i].values, three[i].values) << one[i].name;
}

TEST_F(Features, OfAStoppedRender) {
  scene_ = folder_.read(Wall{kRed}.text());
  std::atomic<bool> stop = true;
  FeatureRequest request;
  request.layers = kAll;
  request.samplesPerPixel = 1000000000;
  request.stop = &stop;
  const auto layers = renderFeatures(scene_, request);
  EXPECT_NEAR(at(layers, LayerKind::kDepth, 2, 6), 4, 1e-4);
  EXPECT_EQ(at(layers, LayerKind::kId, 2, 6), 2);
}

}  // namespace
}  // namespace h2mc
