// SPDX-License-Identifier: MIT
// How much a chain's target favours each part of the film.
#pragma once

#include <vector>

#include "render/image/image.h"

namespace h2mc {

// A positive function on the film that multiplies the target [Veach 1997, section 11.3: two-stage
// Metropolis]. Chains that sample luminance alone spend their time where the picture is bright; divided
// by an estimate of the picture, the relative error becomes the same everywhere. Any such function
// leaves the image's expectation as it is: what is splatted is divided by the target.
class ImportanceMap {
 public:
  // 1 everywhere.
  ImportanceMap() = default;

  // 1 / (luminance + a tenth of the mean), luminance being that of `picture` averaged over cells of
  // cell x cell pixels and blurred over 3 x 3 of them. Scaled so that its mean, weighted by `sampled`,
  // is 1: the target's mean is then the same as without a map, where the chains sample the luminances of
  // `sampled`. Both images of the same size; 1 everywhere where they are black.
  ImportanceMap(const Image& picture, const Image& sampled, int cell);

  void archive(Archive& archive) { archive(columns_, rows_, perX_, perY_, values_); }

  // At a film position in [0,1)^2, interpolated between the cells' centres.
  float operator()(float filmX, float filmY) const {
    return values_.empty() ? 1.f : interpolate(filmX, filmY);
  }

 private:
  float interpolate(float filmX, float filmY) const;

  int columns_ = 0, rows_ = 0;
  float perX_ = 0, perY_ = 0;  // cells in the film's width and height
  std::vector<float> values_;
};

}  // namespace h2mc
