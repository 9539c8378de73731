// SPDX-License-Identifier: MIT
#pragma once

#include "render/core/types.h"

namespace h2mc {

// Where on a texture a surface's (u, v) is looked up: an affine map.
struct TextureMapping {
  Vec2f scale{1}, offset{0};
  Vec2f across{0};  // of v in the texture's u, of u in its v; rarely given

  template <class T>
  Vec2<T> operator()(const Vec2<T>& uv) const {
    using S = Scalar<T>;
    const Vec2<T> straight{uv.x * S(scale.x) + S(offset.x), uv.y * S(scale.y) + S(offset.y)};
    if (across.x == 0 && across.y == 0) [[likely]]
      return straight;
    return {straight.x + uv.y * S(across.x), straight.y + uv.x * S(across.y)};
  }
};

}  // namespace h2mc
