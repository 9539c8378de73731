// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "render/geometry/mesh_place.h"
#include "render/texture/slope.h"

namespace h2mc {

struct Texture;

// What textures ask a mesh for.
struct MeshAttributes {
  std::uint32_t columns = 1;  // of the MeshPlaces that stand for its texture coordinates
  std::vector<glm::uvec3> triangles;
  std::vector<Rgbf> colors;  // one a vertex, linear
  std::vector<Vec2f> uvs;    // empty, or one a vertex
};

// A texture of a mesh whose surface points have MeshPlaces for texture coordinates: the colours of its vertices, or
// another texture, looked up where the mesh's own texture coordinates are.
struct MeshTexture {
  std::shared_ptr<const MeshAttributes> mesh;
  std::shared_ptr<const Texture> texture;  // null: the vertices' colours

  // In texture.h, not inlined: what looks up a texture is not to grow for these.
  template <class T>
  Rgb<T> evaluate(const Vec2<T>& place) const;
  // By the mesh's own texture coordinates. Colours of vertices are flat: they are no function of these.
  template <class T>
  TextureSlope<T> slope(const Vec2<T>& place) const;
  Rgbf average() const;
  Rgbf maximum() const;

 private:
  template <class T>
  Vec2<T> uvAt(const Vec2<T>& place) const;
};

}  // namespace h2mc
