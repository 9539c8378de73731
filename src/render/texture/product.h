// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "render/texture/slope.h"

namespace h2mc {

struct Texture;

// Two textures, multiplied channel by channel: what scales a texture by a colour or by another one.
struct ProductTexture {
  std::shared_ptr<const Texture> first, second;  // not null

  // In texture.h, not inlined: what looks up a texture is not to grow for these.
  template <class T>
  Rgb<T> evaluate(const Vec2<T>& uv) const;
  template <class T>
  TextureSlope<T> slope(const Vec2<T>& uv) const;
  // Exact where one of the two is of one colour, else of 256 x 256 points of the unit square; on a mesh's own
  // coordinates (isOnMesh) an estimate and a bound.
  Rgbf average() const;
  Rgbf maximum() const;
};

}  // namespace h2mc
