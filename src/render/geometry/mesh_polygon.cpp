// SPDX-License-Identifier: MIT
#include "render/geometry/mesh_polygon.h"

#include <algorithm>

namespace h2mc {
namespace {

using Point = glm::dvec2;

// Twice the area, positive counterclockwise.
double areaOf(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners in the plane of their mean normal [Newell], counterclockwise.
std::vector<Point> projected(const std::vector<Vec3f>& positions,
                             std::span<const unsigned> corners) {
  const auto relative = [&](std::size_t i) {
    return glm::dvec3(positions[corners[i]]) - glm::dvec3(positions[corners[0]]);
  };
  glm::dvec3 normal(0);
  for (std::size_t i = 2; i < corners.size(); ++i)
    normal += glm::cross(relative(i - 1), relative(i));
  const glm::dvec3 size = glm::abs(normal);
  const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int x = (drop + 1) % 3, y = (drop + 2) % 3;
  const double sign = normal[drop] < 0 ? -1 : 1;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p = relative(i);
    points.emplace_back(p[x], sign * p[y]);
  }
  return points;
}

// Whether all triangles of a fan around the first corner face the same way, as far as rounding can tell.
bool isFan(const std::vector<Point>& points) {
  double least = 0, sum = 0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const double area = areaOf(points[0], points[i - 1], points[i]);
    least = std::min(least, area);
    sum += area;
  }
  return least >= -1e-7 * sum;
}

class EarCutter {
 public:
  explicit EarCutter(const std::vector<Point>& points) : points_(points) {
    for (std::size_t i = 0; i < points.size(); ++i) left_.push_back(i);
  }

  // Calls add(a, b, c) for each triangle.
  template <class Add>
  void cut(Add add) {
    std::size_t at = 0, failures = 0;
    while (left_.size() > 3 && failures < left_.size()) {
      const std::size_t n = left_.size();
      at %= n;
      const std::size_t a = left_[(at + n - 1) % n], b = left_[at], c = left_[(at + 1) % n];
      if (!isEar(a, b, c)) {
        ++at;
        ++failures;
        continue;
      }
      add(a, b, c);
      left_.erase(left_.begin() + static_cast<long>(at));
      failures = 0;
    }
    for (std::size_t i = 2; i < left_.size(); ++i) add(left_[0], left_[i - 1], left_[i]);
  }

 private:
  bool isEar(std::size_t a, std::size_t b, std::size_t c) const {
    const Point &p = points_[a], &q = points_[b], &r = points_[c];
    if (areaOf(p, q, r) < 0) return false;
    for (const std::size_t i : left_) {
      const Point& x = points_[i];
      if (i == a || i == b || i == c || x == p || x == q || x == r) continue;
      if (areaOf(p, q, x) >= 0 && areaOf(q, r, x) >= 0 && areaOf(r, p, x) >= 0) return false;
    }
    return true;
  }

  const std::vector<Point>& points_;
  std::vector<std::size_t> left_;
};

}  // namespace

bool addPolygon(MeshData& mesh, std::span<const unsigned> corners) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    mesh.triangles.emplace_back(corners[a], corners[b], corners[c]);
  };
  std::vector<Point> points;
  if (corners.size() > 3) points = projected(mesh.positions, corners);
  if (corners.size() == 3 || isFan(points)) {
    for (std::size_t i = 2; i < corners.size(); ++i) add(0, i - 1, i);
    return true;
  }
  if (corners.size() > kMostConcaveCorners) return false;
  EarCutter(points).cut(add);
  return true;
}

}  // namespace h2mc
