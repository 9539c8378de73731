// SPDX-License-Identifier: MIT
// Errors of a comparison's images.
#pragma once

#include "compare/comparison.h"
#include "compare/observer.h"
#include "compare/repeats.h"
#include "render/image/image.h"

namespace h2mc {

// The metrics of a comparison, the first being the main one; those of `h2mc diff` by these names.
const std::vector<std::string>& comparedMetrics();

// Fills in the errors and mean ratios of every point. Throws ImageError; returns false when stopped.
bool measure(SceneRuns& runs, const Image& reference, const ComparisonObserver& observer);

// Bias against variance, from the last images of a method's repeats.
struct BiasCheck {
  Estimate meanRatio;         // of the luminance, to the reference's
  double meanImageError = 0;  // relmse of the mean image of all repeats
  double varianceAlone = 0;   // what their scatter and the reference's own error would leave of it
  // The difference estimated from pairs of repeats, in which scatter cancels: may be below zero.
  // Its standard error is by blocks of pixels. relmse; 0 and 0 with less than two repeats.
  double squaredBias = 0, standardError = 0;
  // The same from images that were scaled to the reference's brightness, whose scatter is common to
  // all blocks, lies three standard errors above zero: the picture is another one.
  bool shows = false;
  // meanRatio's interval, widened by three standard errors of the reference's, leaves 1 out.
  bool brightnessOff = false;
};
BiasCheck checkBias(const MethodRuns& method, const Image& reference, const ReferenceFacts& facts);

}  // namespace h2mc
