// SPDX-License-Identifier: MIT
// Scenes whose numbers float can't hold are brought to where it can, in double, before they are made.
#pragma once

#include <glm/vec3.hpp>

#include "render/scene/scene_document.h"

namespace h2mc {

// What has been taken out of a document: its coordinates are relative to `origin`, radiances in
// multiples of `radiance`.
struct SceneUnits {
  glm::dvec3 origin{0};
  double radiance = 1;
};

// Moves a scene to the camera if all of its shapes and lights lie nearer to it than a 64th of its
// distance from the origin: the origin is then nothing but a loss of digits. (Vertices in a file are
// floats; of those that are far away by themselves the digits are lost already, and nothing happens.)
//
// Divides all that lights emit by a power of two if the brightest is beyond 2^20 or below 2^-20, so
// that it is about 1: products of a radiance, densities and second derivatives then stay in float's
// range. Exact. Not where the picture of an area light would have to be divided.
//
// Leaves everything else alone, and a document that the reader will complain of.
SceneUnits normalise(SceneDocument& document);

}  // namespace h2mc
