// SPDX-License-Identifier: MIT
#include "render/geometry/ray_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/geometry/placed_mesh.h"

namespace h2mc {
namespace {

// The offset relative to the longest edge of the shape's triangles whose plane is not parallel to a coordinate plane:
// Embree finds such a plane only to a few units in the last place of its corners.
constexpr float kTriangleOffset = 0x1p-22f;
// The same relative to the shape's largest coordinate, for origins at (0, 0, 0).
constexpr float kLeastOffset = 0x1p-36f;
// And to an instance's, times its transform's condition.
constexpr float kInstanceOffset = 0x1p-22f;
// Triangles this many times longer than those that the finest shape is made of are vast: else their offset would be
// seen there, a thousandth of a triangle or more.
constexpr float kVast = 0x1p12f;

float largestCoordinate(const Vec3f& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// What float's rounding depends on, of one shape at all steps of its motion.
struct Extent {
  float coordinate = 0;        // largest
  std::vector<float> longest;  // edge of each triangle; for other shapes, one diameter
  std::vector<bool> tilted;    // triangles: Embree's arithmetic across them is not exact
  float condition = 0;         // of an instance's transform
};

void addSphere(const Sphere& sphere, Extent& extent) {
  extent.coordinate = std::max(extent.coordinate, largestCoordinate(sphere.center) + sphere.radius);
  extent.longest[0] = std::max(extent.longest[0], 2 * sphere.radius);
}

void addDisk(const Disk& disk, Extent& extent) {
  const float radius = std::max(glm::length(disk.axisX), glm::length(disk.axisY));
  extent.coordinate = std::max(extent.coordinate, largestCoordinate(disk.center) + radius);
  extent.longest[0] = std::max(extent.longest[0], 2 * radius);
}

void addCylinder(const Cylinder& cylinder, Extent& extent) {
  const float ends = std::max(largestCoordinate(cylinder.start), largestCoordinate(cylinder.end));
  extent.coordinate = std::max(extent.coordinate, ends + cylinder.radius);
  extent.longest[0] = std::max(
      {extent.longest[0], 2 * cylinder.radius, glm::length(cylinder.end - cylinder.start)});
}

// Of triangles at one step of a motion, or at rest.
void addTriangles(const std::vector<glm::uvec3>& triangles, const Vec3f* positions, bool moves,
                  Extent& extent) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const glm::uvec3& t = triangles[i];
    const Vec3f &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
    extent.coordinate = std::max(
        {extent.coordinate, largestCoordinate(a), largestCoordinate(b), largestCoordinate(c)});
    const Vec3f e1 = b - a, e2 = c - a, e3 = c - b;
    extent.longest[i] =
        std::max(extent.longest[i], std::sqrt(std::max({dot(e1, e1), dot(e2, e2), dot(e3, e3)})));
    extent.tilted[i] =
        extent.tilted[i] || moves ||
        !((a.x == b.x && a.x == c.x) || (a.y == b.y && a.y == c.y) || (a.z == b.z && a.z == c.z));
  }
}

// Of an instance: as if it had three triangles. Embree takes rays into the mesh's space in float,
// where a transform that stretches loses more of their digits.
Extent extentOf(const SharedMesh& shared, std::span<const Placement> placements) {
  Extent extent;
  extent.longest = {0, 0, 0};
  extent.tilted = {true, true, true};
  for (const Placement& placement : placements) {
    const Stretch stretch = stretchOf(placement);
    const auto longest = static_cast<float>(stretch.longest);
    for (const glm::dvec3& corner : placedCorners(shared, placement))
      extent.coordinate = std::max(extent.coordinate, largestCoordinate(Vec3f(corner)));
    extent.longest[0] = std::max(extent.longest[0], shared.medianEdge * longest);
    extent.longest[1] = extent.longest[0];  // the median is that of the mesh
    extent.longest[2] = std::max(extent.longest[2], shared.longestEdge * longest);
    extent.condition = std::max(extent.condition, static_cast<float>(stretch.condition));
  }
  return extent;
}

Extent extentOf(const Shape& shape) {
  if (const SharedMesh* const shared = shape.sharedMesh())
    return extentOf(*shared, shape.placements());
  Extent extent;
  const auto reserve = [&](std::size_t count) {
    extent.longest.resize(count, 0);
    extent.tilted.resize(count, false);
  };
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
    reserve(mesh->triangles.size());
    addTriangles(mesh->triangles, mesh->positions.data(), false, extent);
  } else if (const auto* moving = std::get_if<MovingMesh>(&shape.geometry)) {
    reserve(moving->triangles.size());
    for (std::size_t i = 0; i < moving->positions.size(); i += moving->vertices())
      addTriangles(moving->triangles, moving->positions.data() + i, true, extent);
  } else {
    reserve(1);
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) addSphere(*sphere, extent);
    if (const auto* disk = std::get_if<Disk>(&shape.geometry)) addDisk(*disk, extent);
    if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry))
      addCylinder(*cylinder, extent);
    if (const auto* cylinders = std::get_if<MovingCylinder>(&shape.geometry))
      for (const Cylinder& step : cylinders->steps) addCylinder(step, extent);
    if (const auto* spheres = std::get_if<MovingSphere>(&shape.geometry))
      for (const Sphere& step : spheres->steps) addSphere(step, extent);
    if (const auto* disks = std::get_if<MovingDisk>(&shape.geometry))
      for (const Disk& step : disks->steps) addDisk(step, extent);
  }
  return extent;
}

// Median of the positive ones; infinite if there are none.
float median(std::vector<float> lengths) {
  std::erase_if(lengths, [](float x) { return !(x > 0); });
  if (lengths.empty()) return std::numeric_limits<float>::infinity();
  const auto middle = lengths.begin() + static_cast<long>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

RayOffset::RayOffset(std::span<const Shape> shapes) : vast_(shapes.size()) {
  std::vector<Extent> extents;
  float finest = std::numeric_limits<float>::infinity();
  for (const Shape& shape : shapes) {
    extents.push_back(extentOf(shape));
    finest = std::min(finest, median(extents.back().longest));
  }
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const Extent& extent = extents[s];
    float longest = 0;
    for (std::size_t i = 0; shapes[s].isMesh() && i < extent.longest.size(); ++i) {
      if (!extent.tilted[i]) continue;
      if (extent.longest[i] > kVast * finest && !shapes[s].isInstance())
        vast_[s].push_back(static_cast<std::uint32_t>(i));
      else
        longest = std::max(longest, extent.longest[i]);
    }
    slack_.push_back(longest * kTriangleOffset +
                     extent.coordinate *
                         std::max(kLeastOffset, extent.condition * kInstanceOffset));
  }
  slack_.push_back(slack_.empty() ? 0 : *std::max_element(slack_.begin(), slack_.end()));
}

}  // namespace h2mc
