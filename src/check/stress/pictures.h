// SPDX-License-Identifier: MIT
// Whether h2mc's pictures of a scene are those of bdpt, by short renders with error bars.
#pragma once

#include <atomic>
#include <string>

#include "mcmc/chain/mutation.h"
#include "render/scene/scene.h"

namespace h2mc {

struct PictureSettings {
  int maxLength = 8;
  long long samples = 200000;  // of bdpt, and mutations of h2mc, in all runs together
  std::uint64_t seed = 0;
  int threads = 0;  // 0: one a core
  const std::atomic<bool>* stop = nullptr;
};

// Means over independent runs. Errors are standard errors from the runs' scatter.
struct PictureComparison {
  struct Estimate {
    double mean = 0, error = 0;  // of the picture's mean luminance
  };
  Estimate h2mc, bdpt;
  bool made = false;  // all runs were
  // Both relative errors are below kResolved: the verdict means something.
  bool resolved = false;
  // Largest of three differences in their standard errors: of the mean luminance, and of the luminance's
  // balance between left and right and between top and bottom. A chain's brightness comes from
  // independent samples, and the balances are what the chains themselves have to get right. To the
  // latter's standard errors a hundredth of the mean is added, for the shortness of the chains.
  double z = 0;
  long long brokenPixels = 0;  // not finite, in any of the pictures
  long long notFinite = 0;     // contributions
  std::string firstNotFinite;  // replays one of them, where h2mc has met it
  DerivativeCounts derivatives;
  bool interrupted = false;

  bool disagrees() const { return resolved && !(z <= kLimit); }

  static constexpr int kRuns = 8;
  static constexpr double kResolved = 0.05;
  // Student's t with 14 degrees of freedom is beyond it once in 5000 times, one of three in 1700; where
  // few paths carry much of the light more often.
  static constexpr double kLimit = 5;
};

// Renders kRuns pictures by each of the two. Throws what the integrators throw.
PictureComparison comparePictures(const Scene& scene, const PictureSettings& settings);

}  // namespace h2mc
