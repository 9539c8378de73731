// SPDX-License-Identifier: MIT
// Where in a picture to look closer.
#pragma once

#include <vector>

#include "render/image/film_window.h"
#include "render/image/image.h"

namespace h2mc {

// How many are shown.
inline constexpr std::size_t kInsets = 2;

// At most `count` rectangles, 4 : 3, a ninth of the picture's width, apart from each other, where the errors of the
// images differ most from one another (of one image: are largest): the sums over a rectangle of the squared relative
// errors of luminance, each at most 1. None where the picture is too small.
std::vector<PixelRectangle> whereTheyDiffer(const std::vector<Image>& images,
                                            const Image& reference, std::size_t count);

}  // namespace h2mc
