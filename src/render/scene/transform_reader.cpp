// SPDX-License-Identifier: MIT
#include "render/scene/transform_reader.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/core/index.h"
#include "render/scene/suggestion.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

std::vector<double> readNumbers(const XmlElement& element, std::string_view attribute) {
  try {
    return parseNumbers(element.require(attribute));
  } catch (const ValueError& e) {
    throw sourceError(element.place(attribute), e.what());
  }
}

glm::dvec3 readTriple(const XmlElement& element, std::string_view attribute) {
  const std::vector<double> v = readNumbers(element, attribute);
  if (v.size() != 3)
    throw sourceError(element.place(attribute),
                      "expected 3 numbers, here are " + std::to_string(v.size()));
  return {v[0], v[1], v[2]};
}

// Columns: left, up, direction, position, as Mitsuba has it: the camera looks along +z with +x to
// its left.
glm::dmat4 readLookAt(const XmlElement& element) {
  element.allowAttributes({"origin", "target", "up"});
  const glm::dvec3 origin = readTriple(element, "origin"), target = readTriple(element, "target");
  glm::dvec3 direction = target - origin;
  if (glm::length(direction) == 0)
    throw sourceError(element.place("target"), "origin and target are the same point");
  direction = glm::normalize(direction);
  glm::dvec3 up(0);
  if (element.find("up") && !trimmed(element.attribute("up")).empty())
    up = readTriple(element, "up");
  if (glm::length(up) == 0) {
    // Not given: any direction that is not parallel.
    up = std::fabs(direction.x) > std::fabs(direction.y) ? glm::dvec3(-direction.z, 0, direction.x)
                                                         : glm::dvec3(0, direction.z, -direction.y);
  }
  const glm::dvec3 left = glm::cross(glm::normalize(up), direction);
  if (glm::length(left) < 1e-9)
    throw sourceError(element.place("up"), "up is parallel to the direction from origin to target",
                      "expected an up direction across the view");
  const glm::dvec3 x = glm::normalize(left);
  return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(direction, x), 0),
                    glm::dvec4(direction, 0), glm::dvec4(origin, 1));
}

glm::dmat4 readMatrix(const XmlElement& element) {
  element.allowAttributes({"value"});
  const std::vector<double> v = readNumbers(element, "value");
  if (v.size() != 16 && v.size() != 9)
    throw sourceError(element.place("value"),
                      "a matrix has 16 numbers (or 9), here are " + std::to_string(v.size()));
  const int n = v.size() == 16 ? 4 : 3;
  glm::dmat4 m(1);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) m[column][row] = v[at(row * n + column)];
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] == 0)
    throw sourceError(element.place("value"), "the matrix is not affine",
                      "expected 0 0 0 1 in its last row");
  return m / m[3][3];
}

glm::dmat4 readScale(const XmlElement& element) {
  element.allowAttributes({"value", "x", "y", "z"});
  const bool xyz = element.find("x") || element.find("y") || element.find("z");
  if (xyz == (element.find("value") != nullptr))
    throw sourceError(element.place(), xyz ? "<scale> has both value and x, y, z"
                                           : "<scale> has neither value nor x, y, z");
  if (xyz) return glm::scale(glm::dmat4(1), readVector(element, 1));
  const std::vector<double> v = readNumbers(element, "value");
  if (v.size() == 1) return glm::scale(glm::dmat4(1), glm::dvec3(v[0]));
  return glm::scale(glm::dmat4(1), readTriple(element, "value"));
}

glm::dmat4 readRotate(const XmlElement& element) {
  element.allowAttributes({"value", "x", "y", "z", "angle"});
  const glm::dvec3 axis = readVector(element);
  const double angle = readNumber(element, "angle");
  if (glm::length(axis) == 0)
    throw sourceError(element.place(), "the axis of <rotate> is zero",
                      "expected at least one of x, y, z");
  return glm::rotate(glm::dmat4(1), glm::radians(angle), glm::normalize(axis));
}

glm::dmat4 readOperation(const XmlElement& element) {
  static const Names kNames = {"lookat", "matrix", "rotate", "scale", "translate"};
  if (!element.children.empty())
    throw sourceError(element.children[0].place(),
                      "<" + element.children[0].name + "> inside <" + element.name + ">");
  const std::string name = lowerCase(element.name);
  if (name == "lookat" || name == "look_at") return readLookAt(element);
  if (name == "matrix") return readMatrix(element);
  if (name == "scale") return readScale(element);
  if (name == "rotate") return readRotate(element);
  if (name == "translate") {
    element.allowAttributes({"value", "x", "y", "z"});
    return glm::translate(glm::dmat4(1), readVector(element));
  }
  throw sourceError(element.place(), "unknown transformation <" + element.name + ">",
                    suggestion(element.name, kNames));
}

glm::dmat4 readOperations(const XmlElement& transform) {
  glm::dmat4 result(1);
  for (const XmlElement& child : transform.children) result = readOperation(child) * result;
  const glm::dmat3 linear(result);
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  const double determinant = glm::determinant(linear);
  if (!std::isfinite(volume) || !std::isfinite(determinant) ||
      !std::isfinite(glm::length(result[3])))
    throw sourceError(transform.place(), "the numbers of the transformation are too large");
  if (!(std::fabs(determinant) > 1e-12 * volume) || determinant == 0)
    throw sourceError(transform.place(), "the transformation flattens space: it has no inverse");
  return result;
}

}  // namespace

double readNumber(const XmlElement& element, std::string_view attribute) {
  try {
    return parseNumber(element.require(attribute));
  } catch (const ValueError& e) {
    throw sourceError(element.place(attribute), e.what());
  }
}

glm::dvec3 readVector(const XmlElement& element, double missing) {
  if (element.find("value")) {
    if (element.find("x") || element.find("y") || element.find("z"))
      throw sourceError(element.place(), "<" + element.name + "> has both value and x, y, z");
    return readTriple(element, "value");
  }
  return {element.find("x") ? readNumber(element, "x") : missing,
          element.find("y") ? readNumber(element, "y") : missing,
          element.find("z") ? readNumber(element, "z") : missing};
}

Mat4 readTransform(const XmlElement& transform) {
  transform.allowAttributes({"name", "id"});
  return Mat4(readOperations(transform));
}

std::vector<Motion::Keyframe> readAnimation(const XmlElement& animation) {
  animation.allowAttributes({"name", "id"});
  if (animation.children.empty())
    throw sourceError(animation.place(), "<animation> without keyframes",
                      "expected <transform time=\"...\"> inside");
  std::vector<std::pair<Motion::Keyframe, const XmlElement*>> keys;
  for (const XmlElement& key : animation.children) {
    if (key.name != "transform")
      throw sourceError(key.place(), "<" + key.name + "> inside <animation>",
                        "expected <transform time=\"...\">");
    key.allowAttributes({"time", "name"});
    // As precise as the shutter's times: a keyframe at the shutter's opening is at its opening.
    const double time = static_cast<double>(static_cast<float>(readNumber(key, "time")));
    keys.push_back({{time, readOperations(key)}, &key});
  }
  std::stable_sort(keys.begin(), keys.end(),
                   [](const auto& a, const auto& b) { return a.first.time < b.first.time; });
  std::vector<Motion::Keyframe> frames;
  const bool mirrors = glm::determinant(glm::dmat3(keys[0].first.matrix)) < 0;
  for (const auto& [frame, element] : keys) {
    if (!frames.empty() && frame.time == frames.back().time)
      throw sourceError(element->place("time"), "a second keyframe at the same time");
    if ((glm::determinant(glm::dmat3(frame.matrix)) < 0) != mirrors)
      throw sourceError(element->place(), "one keyframe mirrors and another does not",
                        "between them the shape would be flat");
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace h2mc
