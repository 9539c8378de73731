// SPDX-License-Identifier: MIT
// Options of all renders that path tracing and mutations share (split_render.h).
#pragma once

#include "render/integrator/common_options.h"

namespace h2mc {

inline constexpr Parameter kMutationsPerPixelParameter = {
    "mutationsPerPixel", ParameterType::kInteger, "128",
    "mutations for each pixel, if no budget is given"};
inline constexpr Parameter kDirectSamplesParameter = {
    "directSamples", ParameterType::kInteger, "-1",
    "samples a pixel of path tracing for paths of up to two edges, which the chains then leave "
    "out; 0: the chains do all, -1: what makes the whole picture least noisy"};

// Throws OptionError for values of these and of minDepth that are out of range.
inline void checkSplitOptions(const OptionSet& options) {
  for (const char* name : {"minDepth", "mutationsPerPixel"})
    requireRange(options, name, 1, kNoLimit);
  requireRange(options, "directSamples", -1, kNoLimit);
}

}  // namespace h2mc
