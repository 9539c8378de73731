// SPDX-License-Identifier: MIT
// A tilted ground of 10 km, and what is smaller than a millimetre on it.
#pragma once

#include "geometry_cases.h"

namespace h2mc::test {

// The ground's corners are rounded to half a millimetre. Everything else is placed by the plane that these make,
// in metres from a point near its middle.
class VastGround {
 public:
  // `extent`: the length of its edges.
  explicit VastGround(float extent = 1e4f)
      : ground_(moved(parallelogram(Vec3f(-extent / 2, -extent / 2, 0), Vec3f(extent, 0, 0),
                                    Vec3f(0, extent, 0)),
                      tilt(), 1, Vec3f(0.1f, -0.2f, 0.05f))) {
    const auto& p = std::get<TriangleMesh>(ground_.geometry).positions;
    const glm::dvec3 a(p[0]), ab = glm::dvec3(p[1]) - a, ac = glm::dvec3(p[2]) - a;
    normal_ = glm::normalize(glm::cross(ab, ac));
    x_ = glm::normalize(ab);
    y_ = glm::cross(normal_, x_);
    // A fifth of a metre from the edge that the two triangles share.
    middle_ = a + ac * 0.5 + (x_ - y_) * 0.2;
  }

  const Shape& ground() const { return ground_; }
  const glm::dvec3& normal() const { return normal_; }
  glm::dvec3 exactly(double x, double y, double height) const {
    return middle_ + x_ * x + y_ * y + normal_ * height;
  }
  Vec3f at(double x, double y, double height) const { return Vec3f(exactly(x, y, height)); }
  Vec3f along(double x, double y, double height) const {
    return glm::normalize(Vec3f(x_ * x + y_ * y + normal_ * height));
  }

  // A square around (x, y), parallel to the ground.
  Shape card(double x, double y, double height, double halfWidth) const {
    const Vec3f a = at(x - halfWidth, y - halfWidth, height);
    return parallelogram(a, at(x + halfWidth, y - halfWidth, height) - a,
                         at(x - halfWidth, y + halfWidth, height) - a);
  }
  // A cube that stands on the ground.
  Shape box(double x, double y, double width) const {
    Shape shape = cube();
    for (Vec3f& p : std::get<TriangleMesh>(shape.geometry).positions)
      p = at(x + width / 2 * double(p.x), y + width / 2 * double(p.y),
             width / 2 * (1 + double(p.z)));
    return shape;
  }

 private:
  Shape ground_;
  glm::dvec3 normal_, x_, y_, middle_;
};

}  // namespace h2mc::test
