// SPDX-License-Identifier: MIT
// How different two HDR pictures look: HDR-FLIP [Andersson et al. 2021], which takes the largest of
// FLIP's differences [Andersson et al. 2020] over a range of exposures.
#pragma once

#include <memory>

#include "render/image/image.h"

namespace h2mc {

// How pictures are looked at: 67 pixels a degree are a 0.7 m wide monitor with 3840 pixels at 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206432765823;

// Difference of each pixel, 0 (none) to 1, of two pictures that are shown as they are: linear RGB of
// Rec. 709, clamped to [0, 1]. Precondition: images of the same size, not empty, finite.
std::vector<float> flip(const Image& image, const Image& reference,
                        double pixelsPerDegree = kFlipPixelsPerDegree);

// Exposures in stops at which HDR-FLIP looks: from the one that brings the reference's brightest
// pixel to 85 % of the display's range to the one that brings its median there.
struct FlipExposures {
  double start = 0, stop = 0;
  int count = 2;
  double at(int i) const { return start + (stop - start) * i / (count - 1); }
};
FlipExposures flipExposures(const Image& reference);

// Mean over pixels of the largest difference at any of the exposures, tone mapped by the fit of ACES
// [Narkowicz 2015], of any number of images to one reference.
class HdrFlip {
 public:
  // Precondition: not empty.
  explicit HdrFlip(const Image& reference);
  ~HdrFlip();
  HdrFlip(const HdrFlip&) = delete;
  HdrFlip& operator=(const HdrFlip&) = delete;

  // Not a number where a pixel is not finite. Precondition: an image of the reference's size.
  double operator()(const Image& image) const;

 private:
  struct Views;
  std::unique_ptr<Views> views_;  // null: the reference is not finite
};

}  // namespace h2mc
