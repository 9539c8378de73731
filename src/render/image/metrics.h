// SPDX-License-Identifier: MIT
// How far an image is from a reference.
#pragma once

#include <span>
#include <string_view>

#include "render/image/image.h"

namespace h2mc {

// In the formulas a is the image, r the reference, e = a - r, all per channel; mean(...) is over
// pixels and channels; m is the mean luminance of the reference.
struct Metric {
  std::string_view name;
  std::string_view description;  // with the formula
  bool higherIsBetter;
  // Precondition: images of the same size, not empty. A pixel that is not finite makes the result
  // infinite or not a number.
  double (*compute)(const Image& image, const Image& reference);
};

// Every metric; the first is the one to use where nothing else is said.
std::span<const Metric> metrics();
// The metric of this name, or null.
const Metric* findMetric(std::string_view name);

double meanLuminance(const Image& image);

// Pixels with a channel that is infinite or not a number.
long long countNonFinite(const Image& image);

enum class DifferencePicture {
  kSigned,   // (a - r) / (r + 0.01 m) of luminance: yellow to red where the image is brighter, cyan
             // to blue where it is darker, black where they agree; full strength at 1
  kRelative  // its absolute value from 0.001 (dark) to 1 (bright), logarithmic, in false colours
};

// In linear RGB; magenta where a pixel is not finite. Precondition: images of the same size.
Image differencePicture(const Image& image, const Image& reference, DifferencePicture kind);

}  // namespace h2mc
