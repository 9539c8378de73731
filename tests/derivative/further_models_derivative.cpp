// SPDX-License-Identifier: MIT
// Derivatives of paths over bent frames, blends, textured roughness and the rarer models, at rest and moving.
#include <gtest/gtest.h>

#include <cmath>

#include "check/gradcheck/gradcheck.h"
#include "render/image/image_io.h"
#include "render/path/path_text.h"
#include "render/scene/kinds.h"
#include "scene_files.h"

namespace h2mc {
namespace {

// `motion`: the toWorld of two of its shapes, which may be an animation over the time from 0 to 1.
Scene scene(const testing::SceneFolder& folder, const std::string& motion) {
  Image height(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const float a = 0.8f * static_cast<float>(x), b = 0.8f * static_cast<float>(y);
      height.at(x, y) = {0.5f + 0.2f * std::sin(a), 0.5f + 0.2f * std::cos(b), 0.8f};
    }
  writeImage(folder.path() + "height.exr", height);
  const std::string picture = R"(<texture type="bitmap"><string name="filename" value="height.exr"/>
    <float name="uvscale" value="2"/></texture>)";
  const std::string bump =
      R"(<bsdf type="bumpmap"><texture type="scale"><float name="scale" value="0.15"/>)" + picture +
      "</texture>";
  return folder.read(
      R"(<scene version="0.6.0"><sensor type="perspective">
    <transform name="toWorld"><lookat origin="0, 2.2, 6" target="0, 0.8, 0" up="0, 1, 0"/></transform>
    <float name="fov" value="40"/><float name="shutterOpen" value="0"/><float name="shutterClose" value="1"/>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film></sensor>
  <emitter type="spot"><transform name="toWorld"><lookat origin="2, 5, 3" target="0, 0.5, 0" up="0, 1, 0.1"/>
    </transform><rgb name="intensity" value="60"/><float name="cutoffAngle" value="35"/>)" +
      picture.substr(0, 8) + R"( name="texture")" + picture.substr(8) + R"(</emitter>
  <shape type="rectangle"><transform name="toWorld"><scale value="0.8"/><rotate x="1" angle="90"/>
    <translate x="1" y="4" z="1"/></transform>
    <emitter type="area"><rgb name="radiance" value="12, 11, 9"/></emitter></shape>
  <shape type="rectangle"><transform name="toWorld"><scale value="5"/><rotate x="1" angle="-90"/></transform>)" +
      bump + R"(<bsdf type="roughdiffuse"><float name="alpha" value="0.5"/></bsdf></bsdf></shape>
  <shape type="sphere"><float name="radius" value="0.7"/>)" +
      motion + R"(<bsdf type="normalmap">)" + picture + R"(<bsdf type="blendbsdf">
    <float name="weight" value="0.4"/><bsdf type="diffuse"/><bsdf type="roughconductor">
    <float name="alpha" value="0.3"/></bsdf></bsdf></bsdf></shape>
  <shape type="cylinder"><point name="p0" x="-1.8" y="0.3" z="0.6"/><point name="p1" x="-1" y="1.5" z="-0.3"/>
    <float name="radius" value="0.4"/>)" +
      motion + bump + R"(<bsdf type="ward"><float name="alphaU" value="0.2"/>
    <float name="alphaV" value="0.4"/></bsdf></bsdf></shape>
  <shape type="sphere"><point name="center" x="-0.5" y="0.4" z="1.6"/><float name="radius" value="0.4"/>
    <bsdf type="coating"><rgb name="sigmaA" value="0.1, 0.3, 0.5"/><bsdf type="roughconductor">
    <float name="alpha" value="0.25"/></bsdf></bsdf></shape>
  <shape type="sphere"><point name="center" x="0.6" y="0.4" z="1.6"/><float name="radius" value="0.4"/>
    <bsdf type="roughcoating"><float name="alpha" value="0.2"/><rgb name="sigmaA" value="0.5, 0.3, 0.1"/>
    <bsdf type="phong"/></bsdf></shape>
  <shape type="disk"><transform name="toWorld"><scale value="0.7"/><translate x="1.5" y="0.9" z="0.8"/></transform>
    <bsdf type="difftrans"/></shape>
  <shape type="sphere"><point name="center" x="0" y="1.2" z="-0.9"/><float name="radius" value="0.5"/>
    <bsdf type="principled">
    <rgb name="baseColor" value="0.5, 0.3, 0.2"/>)" +
      picture.substr(0, 8) + R"( name="roughness")" + picture.substr(8) + R"(
    <float name="anisotropic" value="0.5"/><float name="metallic" value="0.2"/><float name="specTrans" value="0.4"/>
    <float name="specTint" value="0.3"/><float name="sheen" value="0.3"/><float name="sheenTint" value="0.5"/>
    <float name="flatness" value="0.4"/><float name="clearcoat" value="0.8"/><float name="clearcoatGloss" value="0.1"/>
    </bsdf></shape>
  <shape type="sphere"><point name="center" x="1.9" y="0.6" z="-0.8"/><float name="radius" value="0.6"/>
    <bsdf type="roughconductor"><string name="distribution" value="phong"/>)" +
      picture.substr(0, 8) + R"( name="alpha")" + picture.substr(8) + "</bsdf></shape></scene>");
}

void expectNothingWrong(const Scene& scene, bool moving) {
  GradcheckSettings settings;
  settings.paths = 300;
  settings.maxLength = 4;
  settings.seed = 5;
  settings.threads = 2;
  const GradcheckResult result = gradcheck(scene, settings);
  int judged = 0, moved = 0;
  std::uint32_t kinds = 0;
  for (const PathCheck& p : result.paths) {
    EXPECT_FALSE(p.failed()) << pathText(p.path.technique, p.path.sample);
    judged += p.agree > 0;
    moved += p.traits.moving;
    kinds |= p.traits.bsdfs;
  }
  EXPECT_GT(judged, 250);
  for (const char* wanted : {"ward", "difftrans", "roughdiffuse", "roughconductor", "diffuse",
                             "coating", "roughcoating", "principled"})
    for (std::size_t k = 0; k < bsdfKinds().size(); ++k) {
      if (std::string(bsdfKinds()[k]) == wanted) {
        EXPECT_TRUE((kinds >> k) & 1) << wanted;
      }
    }
  EXPECT_EQ(moved > 20, moving);
}

TEST(FurtherModelsDerivative, NothingIsWrong) {
  const testing::SceneFolder folder;
  expectNothingWrong(scene(folder, R"(<transform name="toWorld"><translate y="0.8"/></transform>)"),
                     false);
}

TEST(FurtherModelsDerivative, NothingIsWrongInMotion) {
  const testing::SceneFolder folder;
  expectNothingWrong(scene(folder, R"(<animation name="toWorld">
    <transform time="0"><translate y="0.8"/></transform>
    <transform time="1"><rotate y="1" angle="40"/><translate x="0.3" y="0.9"/></transform></animation>)"),
                     true);
}

}  // namespace
}  // namespace h2mc
