// SPDX-License-Identifier: MIT
// Small scenes in which paths meet every kind of surface and light, without files of anyone's.
#pragma once

#include <map>

#include "light_cases.h"
#include "render/image/image_io.h"
#include "scene_files.h"

namespace h2mc::test {

// Every BSDF, alone, with textures, in masks and on both sides, on flat, curved and smoothly shaded shapes,
// and the shapes themselves. Every one is within sight of the others: paths of four or five edges take part in
// all. `lights`: XML.
inline Scene galleryScene(const testing::SceneFolder& folder, const std::string& lights) {
  // An octahedron with shading normals that are not those of its faces.
  folder.write("round.obj", R"(v 0.5 0 0
v -0.5 0 0
v 0 0.5 0
v 0 -0.5 0
v 0 0 0.5
v 0 0 -0.5
vn 1 0 0
vn -1 0 0
vn 0 1 0
vn 0 -1 0
vn 0 0 1
vn 0 0 -1
f 1//1 3//3 5//5
f 3//3 2//2 5//5
f 2//2 4//4 5//5
f 4//4 1//1 5//5
f 3//3 1//1 6//6
f 2//2 3//3 6//6
f 4//4 2//2 6//6
f 1//1 4//4 6//6
)");
  Image height(4, 4);
  for (int i = 0; i < 16; ++i) height.at(i % 4, i / 4) = Rgbf(static_cast<float>(i * 7 % 5) / 5);
  writeImage(folder.path() + "height.exr", height);
  const std::string at = "<transform name=\"toWorld\"><translate ";
  return folder.read(
      R"(<scene version="0.6.0"><sensor type="perspective">
<transform name="toWorld"><lookat origin="0.3, 3.4, 6.5" target="0, 0.6, 0" up="0, 1, 0"/></transform>
  <float name="fov" value="42"/>
<film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="4"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="diffuse"><texture name="reflectance" type="checkerboard"><float name="uscale" value="7"/>
  <float name="vscale" value="5"/></texture></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale x="4" y="2" z="1"/><translate y="2" z="-2.5"/>
  </transform>
  <bsdf type="roughplastic"><rgb name="diffuseReflectance" value="0.5, 0.4, 0.3"/>
  <float name="alpha" value="0.2"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="1.6"/><rotate y="1" angle="80"/>
  <translate x="-3" y="1.5"/></transform>
  <bsdf type="twosided"><bsdf type="phong"><float name="exponent" value="30"/>
  <rgb name="specularReflectance" value="0.4"/><rgb name="diffuseReflectance" value="0.3, 0.1, 0.2"/>
  </bsdf></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.45"/>)" +
      at + R"(x="-1.9" y="0.5" z="0.8"/></transform><bsdf type="dielectric"/></shape>
<shape type="sphere"><float name="radius" value="0.5"/>)" +
      at + R"(x="-0.7" y="0.55" z="1.2"/></transform>
  <bsdf type="roughdielectric"><float name="alpha" value="0.15"/><float name="intIOR" value="1.4"/></bsdf>
  </shape>
<shape type="sphere"><float name="radius" value="0.45"/>)" +
      at +
      R"(x="0.5" y="0.5" z="1"/></transform><bsdf type="plastic">
  <rgb name="diffuseReflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>
<shape type="cube"><transform name="toWorld"><scale value="0.4"/><rotate y="1" angle="30"/>
  <translate x="1.7" y="0.45" z="0.9"/></transform>
  <bsdf type="roughconductor"><string name="material" value="Cu"/><float name="alpha" value="0.12"/></bsdf>
  </shape>
<shape type="obj"><string name="filename" value="round.obj"/>)" +
      at +
      R"(x="-1.4" y="0.8" z="-0.9"/></transform><bsdf type="roughconductor">
  <string name="material" value="Al"/>
  <string name="distribution" value="beckmann"/><float name="alpha" value="0.25"/></bsdf></shape>
<shape type="obj"><string name="filename" value="round.obj"/>)" +
      at +
      R"(x="0" y="0.8" z="-0.9"/></transform><bsdf type="dielectric"><float name="intIOR" value="1.3"/>
  </bsdf></shape>
<shape type="obj"><string name="filename" value="round.obj"/>)" +
      at + R"(x="1.3" y="0.8" z="-0.9"/></transform><bsdf type="conductor"/></shape>
<shape type="disk"><transform name="toWorld"><scale value="0.6"/><rotate x="1" angle="-20"/>
  <translate x="2.5" y="1" z="0"/></transform>
  <bsdf type="mask"><texture name="opacity" type="checkerboard"><rgb name="color0" value="0.8"/>
  <rgb name="color1" value="0.3, 0.2, 0.1"/></texture>
  <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.35"/>)" +
      at + R"(x="2.4" y="0.4" z="1.6"/></transform>
  <bsdf type="mask"><float name="opacity" value="0.6"/><bsdf type="plastic"/></bsdf></shape>
<shape type="cylinder"><point name="p0" x="-2.6" y="0.05" z="1.6"/><point name="p1" x="-2.4" y="1.1" z="1.8"/>
  <float name="radius" value="0.3"/><bsdf type="twosided"><bsdf type="bumpmap">
  <texture type="scale"><float name="scale" value="0.2"/><texture type="bitmap">
  <string name="filename" value="height.exr"/></texture></texture>
  <bsdf type="blendbsdf"><texture name="weight" type="checkerboard"/><bsdf type="conductor"/>
  <bsdf type="ward"><float name="alphaU" value="0.2"/><float name="alphaV" value="0.4"/></bsdf></bsdf>
  </bsdf></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="0.5"/><rotate y="1" angle="-30"/>
  <translate x="1.1" y="0.6" z="2"/></transform><bsdf type="thindielectric"/></shape>
<shape type="sphere"><float name="radius" value="0.3"/>)" +
      at + R"(x="-2.6" y="0.3" z="-0.4"/></transform>
  <bsdf type="coating"><rgb name="sigmaA" value="0.1, 0.3, 0.5"/><bsdf type="plastic"/></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.3"/>)" +
      at + R"(x="2.9" y="0.3" z="0.8"/></transform>
  <bsdf type="roughcoating"><float name="alpha" value="0.2"/><bsdf type="phong"/></bsdf></shape>
<shape type="disk"><transform name="toWorld"><scale value="0.4"/><rotate y="1" angle="60"/>
  <translate x="-0.2" y="0.5" z="2"/></transform><bsdf type="difftrans"/></shape>
<shape type="sphere"><float name="radius" value="0.3"/>)" +
      at + R"(x="0.7" y="0.3" z="0.05"/></transform>
  <bsdf type="principled">
    <rgb name="baseColor" value="0.5, 0.3, 0.2"/><float name="roughness" value="0.5"/>
    <float name="anisotropic" value="0.5"/><float name="metallic" value="0.2"/><float name="specTrans" value="0.4"/>
    <float name="specTint" value="0.3"/><float name="sheen" value="0.3"/><float name="sheenTint" value="0.5"/>
    <float name="flatness" value="0.4"/><float name="clearcoat" value="0.8"/><float name="clearcoatGloss" value="0.1"/>
    </bsdf></shape>
)" + lights +
      "</scene>");
}

// Named sets of lights for it, every light plugin among them, area lights on every kind of shape.
inline std::map<std::string, std::string> galleryLights(const testing::SceneFolder& folder) {
  writeImage(folder.path() + "sky.exr", sky(16, 8));
  const std::string radiance = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"";
  return {
      {"area",
       R"(<shape type="rectangle"><transform name="toWorld"><scale value="0.4"/><rotate x="1" angle="90"/>
  <translate x="-1" y="3.5" z="1"/></transform>
)" + radiance +
           R"(14, 13, 10"/></emitter></shape>
<shape type="cube"><transform name="toWorld"><scale value="0.15"/><rotate x="1" y="1" angle="40"/>
  <translate x="0.8" y="2.4" z="0.4"/></transform>)" +
           radiance + R"(9, 10, 14"/></emitter></shape>
<shape type="sphere"><float name="radius" value="0.2"/><transform name="toWorld">
  <translate x="2" y="2.2" z="-0.6"/></transform>)" +
           radiance + R"(10, 6, 6"/></emitter></shape>
<shape type="disk"><transform name="toWorld"><scale value="0.3"/><rotate y="1" angle="120"/>
  <translate x="-2.4" y="1.8" z="2"/></transform>
<emitter type="area"><texture name="radiance" type="checkerboard"><rgb name="color0" value="12, 4, 4"/>
  <rgb name="color1" value="2, 4, 9"/></texture></emitter></shape>)"},
      {"points",
       R"(<emitter type="point"><point name="position" x="-1" y="3" z="2"/>
  <rgb name="intensity" value="9, 8, 7"/></emitter>
<emitter type="spot"><transform name="toWorld">
  <lookat origin="2, 3.5, 1.5" target="0, 0.4, 0" up="0, 1, 0"/></transform>
<rgb name="intensity" value="20, 25, 30"/><float name="cutoffAngle" value="35"/></emitter>)"},
      {"infinite",
       R"(<emitter type="directional"><vector name="direction" x="0.3" y="-1" z="-0.2"/>
  <rgb name="irradiance" value="2"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.5, 0.6, 0.7"/></emitter>)"},
      {"beam",
       R"(<emitter type="collimated"><transform name="toWorld">
  <lookat origin="2, 3.4, 1.5" target="0.75, 0.4, 0.1" up="0, 1, 0"/></transform>
<rgb name="power" value="5, 6, 7"/></emitter>
<emitter type="collimated"><transform name="toWorld">
  <lookat origin="-2, 3, 2" target="-1.9, 0.5, 0.85" up="0, 1, 0"/></transform>
<rgb name="power" value="9, 8, 7"/></emitter>
<emitter type="point"><point name="position" x="-1" y="3" z="2"/><rgb name="intensity" value="3, 2, 2"/>
  </emitter>)"},
      {"sky",
       R"(<emitter type="envmap"><string name="filename" value="sky.exr"/><float name="scale" value="0.5"/>
  </emitter>
<emitter type="point"><point name="position" x="1" y="3" z="2"/><rgb name="intensity" value="3"/>
  </emitter>)"}};
}

}  // namespace h2mc::test
