// SPDX-License-Identifier: MIT
// A card between the eye and the near clipping plane.
#pragma once

#include <string>

namespace h2mc::test {

// A room with a lamp, seen from (0, 1, 5) along -z with the near plane 1 away. The first shape is a card of
// this half width, `distance` before the eye's (first) position. `moving`: the camera travels sideways, so that
// the card covers another part of the picture at each moment.
inline std::string cardScene(bool moving, double distance = 0.5, double halfWidth = 0.12) {
  const auto lookAt = [](const std::string& x) {
    return "<lookat origin=\"" + x + ", 1, 5\" target=\"" + x + ", 1, 0\" up=\"0, 1, 0\"/>";
  };
  const std::string pose = moving ? "<animation name=\"toWorld\"><transform time=\"0\">" +
                                        lookAt("-0.2") + "</transform><transform time=\"1\">" +
                                        lookAt("0.2") + "</transform></animation>"
                                  : "<transform name=\"toWorld\">" + lookAt("0") + "</transform>";
  const std::string shutter =
      moving ? "<float name=\"shutterOpen\" value=\"0\"/><float name=\"shutterClose\" value=\"1\"/>"
             : "";
  return "<scene version=\"0.6.0\"><integrator type=\"path\"><integer name=\"maxDepth\" "
         "value=\"4\"/>"
         "</integrator><sensor type=\"perspective\">" +
         pose + shutter +
         "<float name=\"fov\" value=\"45\"/><float name=\"nearClip\" value=\"1\"/>"
         "<film type=\"hdrfilm\"><integer name=\"width\" value=\"32\"/>"
         "<integer name=\"height\" value=\"24\"/><rfilter type=\"box\"/></film></sensor>"
         "<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"" +
         std::to_string(halfWidth) + "\"/><translate y=\"1\" z=\"" + std::to_string(5 - distance) +
         "\"/></transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>" + R"(
<shape type="rectangle"><transform name="toWorld"><rotate x="1" angle="-90"/><scale value="4"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="4"/><translate z="-3"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.4, 0.5, 0.6"/></bsdf></shape>
<shape type="sphere"><float name="radius" value="0.6"/><point name="center" x="-0.5" y="0.6" z="0"/>
  <bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><rotate x="1" angle="90"/><scale value="0.6"/>
    <translate x="0.8" y="2.8" z="0.5"/></transform>
  <emitter type="area"><rgb name="radiance" value="6"/></emitter></shape>
</scene>
)";
}

}  // namespace h2mc::test
