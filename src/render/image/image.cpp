// SPDX-License-Identifier: MIT
#include "render/image/image.h"

namespace h2mc {

Image averaged(const Image& image, int factor) {
  Image small(image.width / factor, image.height / factor);
  const float share = 1.f / static_cast<float>(factor * factor);
  for (int y = 0; y < small.height * factor; ++y)
    for (int x = 0; x < small.width * factor; ++x)
      small.at(x / factor, y / factor) += image.at(x, y) * share;
  return small;
}

}  // namespace h2mc
