// SPDX-License-Identifier: MIT
#include "render/light/environment_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/scene/change_note.h"
#include "render/scene/properties.h"

namespace h2mc {

EnvironmentTransform environmentTransform(const Properties& properties) {
  constexpr double kNoise = 1e-3;  // of matrices written with few digits
  glm::dmat3 m(properties.transform("toWorld"));
  const double scale = std::cbrt(std::abs(glm::determinant(m)));
  if (!(scale > 0)) properties.fail("toWorld", "expected a transform that can be inverted");
  if (std::abs(scale - 1) > kNoise)
    noteChange(properties, "toWorld", fmt::format("a scale of {:g}", scale),
               "none: directions have no length");
  m = m * (1 / scale);
  EnvironmentTransform result;
  // Newton's iteration for the nearest orthogonal matrix [Higham 1986, "Computing the Polar
  // Decomposition"].
  result.rotation = m;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 next = (result.rotation + glm::transpose(glm::inverse(result.rotation))) * 0.5;
    double change = 0;
    for (int k = 0; k < 3; ++k)
      change = std::max(change, glm::length(next[k] - result.rotation[k]));
    result.rotation = next;
    if (change < 1e-14) break;
  }
  result.stretch = glm::transpose(result.rotation) * m;
  double deviation = 0;
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 identity(0);
    identity[k] = 1;
    deviation = std::max(deviation, glm::length(result.stretch[k] - identity));
  }
  result.stretches = deviation > kNoise;
  if (result.stretches)
    properties.warn("toWorld",
                    "the transform of the environment map stretches directions, by up to " +
                        std::to_string(static_cast<int>(std::ceil(100 * deviation))) + " %");
  return result;
}

Image stretched(const Image& image, const glm::dmat3& stretch) {
  constexpr int kSub = 2;  // samples along a pixel's edge
  const glm::dmat3 inverse = glm::inverse(stretch);
  Image result(image.width, image.height);
  const auto lookUp = [&](double x, double y) {
    const double left = std::floor(x), top = std::floor(y), a = x - left, b = y - top;
    const auto texel = [&](double i, double j) {
      const int column = static_cast<int>(i) % image.width;
      return glm::dvec3(image.at(column < 0 ? column + image.width : column,
                                 std::clamp(static_cast<int>(j), 0, image.height - 1)));
    };
    return (texel(left, top) * (1 - a) + texel(left + 1, top) * a) * (1 - b) +
           (texel(left, top + 1) * (1 - a) + texel(left + 1, top + 1) * a) * b;
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::dvec3 sum(0);
      for (int k = 0; k < kSub * kSub; ++k) {
        const int column = k % kSub, row = k / kSub;
        const double u = (x + (column + 0.5) / kSub) / image.width;
        const double v = (y + (row + 0.5) / kSub) / image.height;
        const double phi = 2 * std::numbers::pi * u, theta = std::numbers::pi * v;
        const glm::dvec3 d = inverse * glm::dvec3(std::sin(phi) * std::sin(theta), std::cos(theta),
                                                  -std::cos(phi) * std::sin(theta));
        const double turn = std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
        const double fall = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
        sum += lookUp((turn < 0 ? turn + 1 : turn) * image.width - 0.5, fall * image.height - 0.5);
      }
      result.at(x, y) = Rgbf(sum / static_cast<double>(kSub * kSub));
    }
  return result;
}

}  // namespace h2mc
