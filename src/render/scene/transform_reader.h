// SPDX-License-Identifier: MIT
// Transforms of a scene file: lookat, matrix, scale, rotate, translate in the order they are
// written.
#pragma once

#include "render/core/motion.h"
#include "render/core/types.h"
#include "render/scene/xml_document.h"

namespace h2mc {

// Reads the operations inside a <transform>. Throws SceneError; the result is affine and can be
// inverted.
Mat4 readTransform(const XmlElement& transform);

// Reads the keyframes of an <animation>, in the order of their times. Throws SceneError where there are
// none, two are at the same time, or one mirrors and another does not.
std::vector<Motion::Keyframe> readAnimation(const XmlElement& animation);

// Three numbers from x, y, z (each `missing` when it is not given) or from value="x, y, z".
glm::dvec3 readVector(const XmlElement& element, double missing = 0);

// One number from an attribute that must be there; SceneError at the attribute.
double readNumber(const XmlElement& element, std::string_view attribute);

}  // namespace h2mc
