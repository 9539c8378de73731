// SPDX-License-Identifier: MIT
// What becomes of a scene's paths, derivatives and pictures where numbers are hard: `h2mc stress`.
//
// The paths are gradcheck's: half connections of bidirectional samples, half states of h2mc's chains.
// Of each, the float derivatives that chains use are compared with those of the same contribution in
// double, as gradcheck measures errors: the value's absolute (of a logarithm), the Hessian's relative
// to max(1, |H|) in the Frobenius norm, the gradient's to max(|g|, root of the same). How large they
// are is reported and not judged: a path of many glossy vertices magnifies any rounding. What is judged
// is that every contribution and every pixel is finite, and that h2mc's pictures are bdpt's.
#pragma once

#include <string>

#include "check/stress/pictures.h"

namespace h2mc {

// Where the coordinates of the paths are.
enum class CoordinatePlacement {
  kDrawn,
  kZero,     // each coordinate of a sampled path in turn, and all together, at 0
  kBelowOne  // at 1 - 2^-24
};

struct StressSettings {
  int paths = 400;
  int maxLength = 8;
  long long samples = 200000;  // for the pictures, see PictureSettings; 0: none are made
  std::uint64_t seed = 0;
  int threads = 0;  // 0: one a core
  CoordinatePlacement placement = CoordinatePlacement::kDrawn;
  const std::atomic<bool>* stop = nullptr;
};

// One of the errors over all paths.
struct ErrorSpread {
  double median = 0, worst = 0;
  std::string replay;  // of the worst
};

struct StressFindings {
  long long paths = 0;         // whose target is positive: the errors are theirs
  long long notFinite = 0;     // contributions, wherever they were met; each is a defect
  std::string firstNotFinite;  // replays one of them
  // Paths for which the Hamiltonian step falls back to its prior: derivatives not finite.
  long long fallbacks = 0;
  std::string firstFallback;
  DerivativeCounts chains;        // the same in the chains, the pictures' included
  long long doubleNotFinite = 0;  // derivatives in double: nothing to compare with
  ErrorSpread value, gradient, hessian;
  PictureComparison pictures;
  bool interrupted = false;

  double fallbackShare() const {
    return paths > 0 ? static_cast<double>(fallbacks) / static_cast<double>(paths) : 0;
  }
  double chainFallbackShare() const {
    return chains.computed > 0
               ? static_cast<double>(chains.notFinite) / static_cast<double>(chains.computed)
               : 0;
  }
  bool failed() const { return notFinite > 0 || pictures.brokenPixels > 0 || pictures.disagrees(); }
};

// Throws what the bootstrap and the integrators throw.
StressFindings stressScene(const Scene& scene, const StressSettings& settings);

}  // namespace h2mc
