// SPDX-License-Identifier: MIT
// Whether a picture's values can be light or a colour.
#pragma once

#include <optional>

#include "render/image/image.h"
#include "render/scene/properties.h"

namespace h2mc {

// Looks at every pixel of the picture that the parameter "filename" names. Values that are not finite are an error;
// negative ones too in files of version 2 and above, unless p.texelsMayBeNegative(). The message names the file and the
// first such pixel, and counts them. Where it is no more than a warning, returns the picture with 0 in their place.
std::optional<Image> mendedTexels(const Properties& p, const Image& image);

}  // namespace h2mc
