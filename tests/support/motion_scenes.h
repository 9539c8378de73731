// SPDX-License-Identifier: MIT
// Scenes in which things move, without files.
#pragma once

#include <string>

namespace h2mc::test {

// The scene with a thin lens before its camera.
inline std::string withThinLens(std::string scene, double radius, double focus) {
  const std::string pinhole = "<sensor type=\"perspective\">";
  return scene.replace(scene.find(pinhole), pinhole.size(),
                       "<sensor type=\"thinlens\"><float name=\"apertureRadius\" value=\"" +
                           std::to_string(radius) + "\"/><float name=\"focusDistance\" value=\"" +
                           std::to_string(focus) + "\"/>");
}

// The scene seen by an orthographic camera, its film of this half width.
inline std::string seenInParallel(std::string scene, double halfWidth) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    scene.replace(scene.find(from), from.size(), to);
  };
  const std::string size = std::to_string(halfWidth);
  replace("<sensor type=\"perspective\"><transform name=\"toWorld\">",
          "<sensor type=\"orthographic\"><transform name=\"toWorld\"><scale x=\"" + size +
              "\" y=\"" + size + "\"/>");
  const std::size_t fov = scene.find("<float name=\"fov\"");
  return scene.erase(fov, scene.find("/>", fov) + 2 - fov);
}

// Everything that can move does: a glossy cube that turns, a sphere, a lamp that turns and grows, a disk
// that tilts, a camera that travels and turns; but the floor, a box and a second lamp stand still.
// Half of the picture shows what does not move. `open` and `close`: the shutter.
// `camera`: whether the camera moves.
inline std::string halfMovingScene(double open, double close, bool camera, int width = 40,
                                   int height = 30) {
  const std::string still =
      "<transform name=\"toWorld\"><lookat origin=\"0.2, 3, 7\" target=\"0, 0.7, 0\" up=\"0, 1, "
      "0\"/>"
      "</transform>";
  const std::string travelling =
      "<animation name=\"toWorld\">"
      "<transform time=\"0\"><lookat origin=\"0.2, 3, 7\" target=\"0, 0.7, 0\" up=\"0, 1, 0\"/>"
      "</transform><transform time=\"0.6\"><lookat origin=\"0.5, 3.1, 6.8\" target=\"-0.2, 0.8, "
      "0\" "
      "up=\"0.1, 1, 0\"/></transform><transform time=\"1\"><lookat origin=\"0.7, 2.9, 6.8\" "
      "target=\"-0.3, 0.7, 0\" up=\"0.1, 1, 0\"/></transform></animation>";
  return std::string(
             "<scene version=\"0.6.0\"><integrator type=\"path\"><integer name=\"maxDepth\" "
             "value=\"4\"/></integrator><sensor type=\"perspective\">") +
         (camera ? travelling : still) +
         "<float name=\"fov\" value=\"40\"/><float name=\"shutterOpen\" value=\"" +
         std::to_string(open) + "\"/><float name=\"shutterClose\" value=\"" +
         std::to_string(close) + "\"/><film type=\"hdrfilm\"><integer name=\"width\" value=\"" +
         std::to_string(width) + "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
         "\"/><rfilter type=\"box\"/></film></sensor>" + R"(
<shape type="rectangle" id="floor"><transform name="toWorld"><scale value="6"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="roughplastic"><rgb name="diffuseReflectance" value="0.4, 0.4, 0.35"/>
    <float name="alpha" value="0.2"/></bsdf></shape>
<shape type="cube" id="box">
  <transform name="toWorld"><scale value="0.6"/><translate x="-2" y="0.6" z="-0.5"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.3"/></bsdf></shape>
<shape type="rectangle" id="still lamp"><transform name="toWorld">
  <scale value="0.5"/><rotate x="1" angle="90"/><translate x="-2" y="3.5" z="1"/></transform>
  <emitter type="area"><rgb name="radiance" value="14, 13, 10"/></emitter></shape>
<shape type="cube" id="turning cube"><animation name="toWorld">
  <transform time="0"><scale x="0.4" y="0.7" z="0.4"/><translate x="1.2" y="0.8"/></transform>
  <transform time="1"><scale x="0.4" y="0.7" z="0.4"/><rotate y="1" x="0.3" angle="80"/>
    <translate x="1.5" y="0.9" z="0.2"/></transform></animation>
  <bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.25"/></bsdf></shape>
<shape type="sphere" id="rolling sphere"><float name="radius" value="0.4"/><animation name="toWorld">
  <transform time="0"><translate x="0" y="0.4" z="1"/></transform>
  <transform time="0.5"><translate x="0.4" y="0.7" z="1.4"/></transform>
  <transform time="1"><scale value="1.3"/><translate x="0.9" y="0.55" z="1.6"/></transform></animation>
  <bsdf type="plastic"><rgb name="diffuseReflectance" value="0.6, 0.2, 0.1"/></bsdf></shape>
<shape type="disk" id="tilting disk"><animation name="toWorld">
  <transform time="0"><scale x="0.5" y="0.7" z="1"/><translate x="2.2" y="1" z="-1.4"/></transform>
  <transform time="1"><scale x="0.6" y="0.7" z="1"/><rotate y="1" angle="40"/>
    <translate x="2" y="1.4" z="-1.2"/></transform></animation>
  <bsdf type="twosided"><bsdf type="phong"><rgb name="specularReflectance" value="0.5"/>
    <rgb name="diffuseReflectance" value="0.3"/><float name="exponent" value="20"/></bsdf></bsdf></shape>
<shape type="rectangle" id="moving lamp"><animation name="toWorld">
  <transform time="0"><scale value="0.4"/><rotate x="1" angle="90"/><translate x="1" y="3" z="0.5"/></transform>
  <transform time="1"><scale x="0.7" y="0.4" z="0.5"/><rotate x="1" angle="90"/>
    <rotate z="1" angle="30"/><translate x="2" y="2.7" z="1"/></transform></animation>
  <emitter type="area"><rgb name="radiance" value="10, 11, 14"/></emitter></shape>
</scene>)";
}

}  // namespace h2mc::test
