// SPDX-License-Identifier: MIT
// Small scenes for tests that chains keep their distribution: between them all that a mutation can meet.
#pragma once

#include <string>

#include "motion_scenes.h"
#include "scene_files.h"

namespace h2mc::test {

struct ExactnessScene {
  const char* name;
  std::string xml;
  int maxLength;
};

// A directly seen lamp, a beam, a room of diffuse and lacquered walls, a rough metal sphere and a mirror; no front
// wall, so that the camera sees what light subpaths reach.
inline std::string roomScene() {
  return R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="perspective"><transform name="toWorld"><lookat origin="0, 1, 4.2" target="0, 0.9, 0" up="0, 1, 0"/>
    </transform>
  <float name="fov" value="45"/><film type="hdrfilm"><integer name="width" value="16"/>
    <integer name="height" value="12"/></film></sensor>
<bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.7, 0.7, 0.65"/></bsdf>
<bsdf type="principled" id="red"><rgb name="baseColor" value="0.6, 0.1, 0.1"/><float name="roughness" value="0.6"/>
  <float name="anisotropic" value="0.5"/><float name="clearcoat" value="0.7"/><float name="sheen" value="0.3"/></bsdf>
<shape type="rectangle"><transform name="toWorld"><rotate x="1" angle="-90"/></transform><ref id="white"/></shape>
<shape type="rectangle"><transform name="toWorld"><translate y="1" z="-1"/></transform><ref id="white"/></shape>
<shape type="rectangle"><transform name="toWorld"><rotate y="1" angle="90"/><translate x="-1" y="1"/></transform>
    <ref id="red"/></shape>
<shape type="rectangle"><transform name="toWorld"><rotate y="1" angle="-90"/><translate x="1" y="1"/></transform>
  <bsdf type="conductor"><string name="material" value="Ag"/></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.4"/><point name="center" x="-0.3" y="0.4" z="0.1"/>
  <bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.2"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="0.35"/><rotate x="1" angle="70"/>
    <translate y="1.7" z="-0.3"/></transform>
  <ref id="white"/><emitter type="area"><rgb name="radiance" value="10, 9, 7"/></emitter></shape>
<emitter type="collimated"><transform name="toWorld"><lookat origin="0.6, 1.8, 0.9" target="-0.25, 0.5, 0.1"
  up="0, 1, 0"/></transform><rgb name="power" value="2, 2, 1.5"/></emitter>
</scene>)";
}

// Smooth and rough glass under a lamp and a sky of one colour, on a glossy floor.
inline std::string glassScene() {
  return R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="perspective"><transform name="toWorld"><lookat origin="0.3, 1.6, 4" target="0, 0.5, 0" up="0, 1, 0"/>
    </transform>
  <float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="16"/>
    <integer name="height" value="12"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="3"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="roughplastic"><rgb name="diffuseReflectance" value="0.5, 0.45, 0.4"/><float name="alpha" value="0.25"/>
    </bsdf></shape>
<shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="-0.7" y="0.5" z="0"/>
    <bsdf type="dielectric"/></shape>
<shape type="cube"><transform name="toWorld"><scale value="0.4"/><rotate y="1" angle="30"/>
    <translate x="0.7" y="0.45" z="0.1"/></transform>
  <bsdf type="roughdielectric"><float name="alpha" value="0.3"/></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.3"/><point name="center" x="0.2" y="2.2" z="-0.8"/>
  <emitter type="area"><rgb name="radiance" value="14, 13, 10"/></emitter></shape>
<emitter type="constant"><rgb name="radiance" value="0.15, 0.2, 0.3"/></emitter>
</scene>)";
}

// An environment map with a sun before it, an instance of a half-transparent mask, a spot light, a blend, and a surface
// with bumps.
inline std::string skyScene() {
  const std::string sky = std::string(H2MC_SOURCE_DIR) + "/scenes/torus/sky.hdr";
  return R"(<scene version="0.6.0"><integrator type="path"/>
<sensor type="perspective"><transform name="toWorld"><lookat origin="0, 1.4, 4" target="0, 0.5, 0" up="0, 1, 0"/>
    </transform>
  <float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="16"/>
    <integer name="height" value="12"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="2"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="diffuse"><texture name="reflectance" type="checkerboard"><rgb name="color0" value="0.7"/>
    <rgb name="color1" value="0.2, 0.25, 0.3"/><float name="uscale" value="4"/><float name="vscale" value="4"/>
    </texture></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="-0.5" y="0.5" z="0"/>
  <bsdf type="bumpmap"><texture type="scale"><float name="scale" value="0.05"/><texture type="bitmap">
      <string name="filename" value=")" +
         sky + R"("/></texture></texture>
    <bsdf type="blendbsdf"><float name="weight" value="0.7"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.3, 0.2, 0.2"/></bsdf>
      <bsdf type="phong"><rgb name="specularReflectance" value="0.5"/>
        <rgb name="diffuseReflectance" value="0.3, 0.2, 0.2"/><float name="exponent" value="15"/></bsdf></bsdf>
    </bsdf></shape>
<shape type="shapegroup" id="card"><shape type="rectangle">
  <bsdf type="mask"><rgb name="opacity" value="0.6"/><bsdf type="twosided"><bsdf type="diffuse">
    <rgb name="reflectance" value="0.3, 0.5, 0.2"/></bsdf></bsdf></bsdf></shape></shape>
<shape type="instance"><ref id="card"/><transform name="toWorld"><scale x="0.7" y="0.5" z="3"/>
    <rotate y="1" angle="-30"/><translate x="0.6" y="0.6" z="0.5"/></transform></shape>
<emitter type="sun"><vector name="sunDirection" x="-0.5" y="0.7" z="0.6"/><float name="sunRadiusScale" value="40"/>
  <float name="scale" value="1.5"/></emitter>
<emitter type="spot"><transform name="toWorld"><lookat origin="1.5, 2.5, 1.5" target="0, 0, 0" up="0, 1, 0"/>
    </transform>
  <rgb name="intensity" value="8, 8, 7"/><float name="cutoffAngle" value="30"/></emitter>
<emitter type="envmap"><string name="filename" value=")" +
         sky + R"("/><float name="scale" value="0.4"/></emitter>
</scene>)";
}

inline std::vector<ExactnessScene> exactnessScenes() {
  return {{"room", roomScene(), 4},
          {"moving", withThinLens(halfMovingScene(0, 1, true, 16, 12), 0.2, 6), 4},
          {"glass", withThinLens(glassScene(), 0.15, 4), 5},
          {"sky", seenInParallel(skyScene(), 1.4), 4}};
}

}  // namespace h2mc::test
