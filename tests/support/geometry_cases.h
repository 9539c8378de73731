// SPDX-License-Identifier: MIT
// Shapes for tests of geometry and lights.
#pragma once

#include <cmath>
#include <vector>

#include "render/core/random.h"
#include "render/geometry/shape.h"
#include "render/geometry/surface.h"

namespace h2mc::test {

inline Vec3f randomDirection(Random& random) {
  const double z = 2 * random.uniformDouble() - 1, phi = 2 * M_PI * random.uniformDouble();
  const double rho = std::sqrt(1 - z * z);
  return Vec3f(glm::dvec3(rho * std::cos(phi), rho * std::sin(phi), z));
}
inline Vec3f randomPoint(Random& random) {
  const float x = random.uniform(), y = random.uniform(), z = random.uniform();
  return Vec3f(x, y, z) * 2.0f - 1.0f;
}

// A rotation with no entry near 0 or 1.
inline glm::mat3 tilt() {
  const Vec3f n = glm::normalize(Vec3f(0.37f, -0.61f, 0.53f));
  const Frame<float> f = Frame<float>::fromNormal(n);
  return glm::mat3(f.s, f.t, f.n);
}

inline Shape meshShape(std::vector<Vec3f> positions, std::vector<glm::uvec3> triangles) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  return {"mesh", std::move(mesh)};
}

// Triangles with corners near a random point of the cube [-1, 1]^3.
inline Shape soup(int count, float size, std::uint64_t seed) {
  Random random(seed, 1, 0);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3f center = randomPoint(random);
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + randomPoint(random) * size);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return {"soup", std::move(mesh)};
}

// The cube [-1, 1]^3 with normals outwards.
inline Shape cube() {
  std::vector<Vec3f> p;
  for (int i = 0; i < 8; ++i)
    p.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
  return meshShape(p, {{0, 2, 3},
                       {0, 3, 1},
                       {4, 5, 7},
                       {4, 7, 6},
                       {0, 1, 5},
                       {0, 5, 4},
                       {2, 6, 7},
                       {2, 7, 3},
                       {0, 4, 6},
                       {0, 6, 2},
                       {1, 3, 7},
                       {1, 7, 5}});
}

// A unit sphere of triangles, with shading normals where asked for.
inline Shape ball(int rings, bool smooth) {
  TriangleMesh mesh;
  const int segments = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double theta = M_PI * i / rings, phi = 2 * M_PI * j / segments;
      mesh.positions.push_back(Vec3f(glm::dvec3(std::sin(theta) * std::cos(phi),
                                                std::sin(theta) * std::sin(phi), std::cos(theta))));
    }
  const auto id = [&](int i, int j) { return static_cast<unsigned>(i * segments + j % segments); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      if (i > 0) mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      if (i < rings - 1) mesh.triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
    }
  if (smooth) mesh.normals = mesh.positions;
  return {"ball", std::move(mesh)};
}

inline Shape sphere(const Vec3f& center, float radius, bool flip = false) {
  return {"sphere", Sphere{center, radius, flip, tilt()}};
}

inline Shape cylinder(const Vec3f& start, const Vec3f& end, float radius, bool flip = false) {
  const Frame<float> across = Frame<float>::fromNormal(glm::normalize(end - start));
  return {"cylinder", Cylinder{start, end, radius, across.s, flip}};
}

inline Shape disk(const Vec3f& center, const Vec3f& axisX, const Vec3f& axisY) {
  return {"disk", Disk{center, axisX, axisY, glm::normalize(glm::cross(axisX, axisY))}};
}

inline Shape parallelogram(const Vec3f& a, const Vec3f& e, const Vec3f& f) {
  Shape s = meshShape({a, a + e, a + e + f, a + f}, {{0, 1, 2}, {2, 3, 0}});
  std::get<TriangleMesh>(s.geometry).parallelogram = true;
  return s;
}

// The shape rotated by m, scaled, and moved.
inline Shape moved(Shape shape, const glm::mat3& m, float scale, const Vec3f& by) {
  if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
    for (Vec3f& p : mesh->positions) p = m * p * scale + by;
    for (Vec3f& n : mesh->normals) n = glm::normalize(m * n);
  } else if (auto* s = std::get_if<Sphere>(&shape.geometry)) {
    s->center = m * s->center * scale + by;
    s->radius *= scale;
  } else if (auto* c = std::get_if<Cylinder>(&shape.geometry)) {
    c->start = m * c->start * scale + by;
    c->end = m * c->end * scale + by;
    c->axisX = m * c->axisX;
    c->radius *= scale;
  } else {
    auto& d = std::get<Disk>(shape.geometry);
    d.center = m * d.center * scale + by;
    d.axisX = m * d.axisX * scale;
    d.axisY = m * d.axisY * scale;
    d.normal = glm::normalize(m * d.normal);
  }
  return shape;
}

}  // namespace h2mc::test
