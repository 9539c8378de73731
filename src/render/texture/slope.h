// SPDX-License-Identifier: MIT
#pragma once

#include "render/core/types.h"

namespace h2mc {

// A texture's colour and its first derivatives by the surface's texture coordinates.
template <class T>
struct TextureSlope {
  Rgb<T> value, du, dv;
};

}  // namespace h2mc
