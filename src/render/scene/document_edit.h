// SPDX-License-Identifier: MIT
// Changes to a scene's document before the scene is made of it: another material, another scale,
// another place. Nothing of what has been built is touched, so the result is a scene as any other.
//
// Each returns how many elements it has changed: 0 where the document has nothing of the kind, or has
// that value already. Ids stay valid. Values that can't be read are left for the reader to complain of.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "render/scene/scene_document.h"

namespace h2mc {

// alpha of every rough BSDF. Precondition: alpha > 0.
int setRoughness(SceneDocument& document, double alpha);

// exponent of every phong BSDF. Precondition: exponent >= 0.
int setPhongExponent(SceneDocument& document, double exponent);

// Refractive index inside of every BSDF with a dielectric interface, with 1 outside. Rough ones and coats
// do not exist without a difference: at index 1 they stay as they are. Precondition: index > 0.
int setRefractiveIndex(SceneDocument& document, double index);

// Multiplies what every light emits. The picture of an area light can't be multiplied: it stays.
// Precondition: factor > 0.
int scaleRadiance(SceneDocument& document, double factor);

// Shrinks every area light on a rectangle, disk, cube or sphere around its middle to `share` of its
// area and divides its radiance by the same, so that its power stays. Lights on meshes, and those whose
// emitter is a <ref>, stay. Precondition: share > 0.
int shrinkLights(SceneDocument& document, double share);

// p -> scale * p + offset for all that has a place: shapes, lights, the camera with its clipping
// planes. What point and spot lights emit grows with scale^2, so that the picture stays the same.
// Precondition: scale > 0.
int moveScene(SceneDocument& document, double scale, const glm::dvec3& offset);

// Where things stand, to float's precision: shapes and point lights by the middle of their own
// coordinates, at the first keyframe where they move. No things where there is no camera. Throws
// SceneError for what can't be read.
struct ScenePlaces {
  glm::dvec3 camera{0};
  std::vector<glm::dvec3> things;
};
ScenePlaces placesOf(const SceneDocument& document);

// The largest number that a light emits in any channel: radiance or irradiance, or the intensity of
// point lights where there are no others. 0 where scaleRadiance could not multiply all of them. Throws
// SceneError for what can't be read.
double brightestLight(const SceneDocument& document);

}  // namespace h2mc
