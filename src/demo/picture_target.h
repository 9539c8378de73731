// SPDX-License-Identifier: MIT
// A picture as a function on the unit square, smooth enough for derivatives.
#pragma once

#include "render/image/image.h"
#include "render/path/derivative.h"

namespace h2mc {

// Colours are the uniform cubic B-spline with the pixels as its control points: twice continuously
// differentiable, and nowhere darker than the darkest pixel around. (0, 0) is the upper left corner.
class PictureTarget {
 public:
  // Black is lifted to a thousandth of the mean, so that the target is positive.
  // Precondition: finite, not negative, not all black.
  explicit PictureTarget(const Image& picture);

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }

  // x, y in [0, 1].
  Rgbf color(float x, float y) const;
  // Gradient and Hessian of the logarithm of the colour's luminance with respect to (x, y).
  void differentiate(float x, float y, Derivative& result) const;

  // What sampling converges to: the function's mean over each pixel, by 4 x 4 points.
  Image pixelMeans() const;

 private:
  Image picture_;
};

// The picture at most `width` pixels wide, by means of areas; itself if it is not wider.
Image shrunk(const Image& picture, int width);

}  // namespace h2mc
