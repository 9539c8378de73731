// SPDX-License-Identifier: MIT
// Radiance to what a screen can show, for looking at.
#pragma once

#include <optional>

#include "render/image/image.h"

namespace h2mc {

enum class ToneCurve {
  kSrgb,   // none: what is above 1 is clipped
  kFilmic  // with a toe and a shoulder, from 0 to 1
};

struct ToneMapping {
  std::optional<double> stops =
      0;  // exposure: values times 2^stops; none: by the picture, autoExposure()
  ToneCurve curve = ToneCurve::kSrgb;
};

// The stops by which the geometric mean of the picture's luminances becomes middle grey, 0.18 [Reinhard et al. 2002,
// eqs. 1 and 2]. Of pixels that are lit; 0 where there are none.
double autoExposure(const Image& image);

// The picture after exposure and curve, linear: a PNG's sRGB encoding comes after it.
Image toneMapped(const Image& image, const ToneMapping& mapping);

}  // namespace h2mc
