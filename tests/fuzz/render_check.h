// SPDX-License-Identifier: MIT
// What a scene that was read promises: pictures that are pictures, and integrators that agree.
#pragma once

#include "render/scene/scene.h"

namespace h2mc::fuzz {

// Renders the scene by path, h2mc and the integrator that it asks for, with next to no samples. Throws Finding where a
// pixel is not finite or negative, or where the brightness differs by more than chance can explain.
//
// When is that? Few paths may carry most of the light, and an integrator that has met none of them is sure of itself
// and wrong: no number of standard errors helps, since the error itself is wrong. What helps is which of two was wrong.
// bdpt has path's techniques among its own, and weighs each by how often it samples a path: nothing that path finds
// often is rare in bdpt. And h2mc's brightness is that of bdpt's sampler. So
//
// - bdpt and h2mc miss alike, and must agree;
// - path may be darker than bdpt, and not brighter;
// - nor darker in a scene where it has no way to miss: diffuse surfaces, and no lamp that is small or a point.
//
// Differences are those of means over kRuns runs, by their scatter: 8 standard errors (Student's t with 14 degrees of
// freedom: once in 700,000 times) and a tenth, in the first short renders, and twice again with other seeds. That is
// less than once in 10^12 times where runs are normally distributed, which leaves room for those that are not.
void checkRender(const Scene& scene);

}  // namespace h2mc::fuzz
