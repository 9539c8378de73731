// SPDX-License-Identifier: MIT
// The scene's picture in small, so that one sees where a path is.
#pragma once

#include <atomic>
#include <cstdint>

#include "render/image/image.h"

namespace h2mc {

struct Scene;

// Share of a preview's pixels that may be too bright to show: it is noisy.
inline constexpr double kNoisy = 0.02;

// Linear RGB, noisy; 160 pixels along its longer edge, fewer if the film has fewer. By bidirectional
// path tracing of paths up to maxLength edges. The same for any number of threads. Black, or part of
// it, where `stop` is set on the way.
Image previewFilm(const Scene& scene, int maxLength, std::uint64_t seed, int threads,
                  const std::atomic<bool>* stop);

}  // namespace h2mc
