// SPDX-License-Identifier: MIT
// The variations of a scene that `h2mc stress` looks at.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/stress/stress.h"
#include "render/scene/scene_reader.h"

namespace h2mc {

struct Variation {
  std::string name;         // "alpha=0.01", as --only takes it
  std::string description;  // one line
  // Changes the document and returns how many elements it has changed; empty: it stays.
  std::function<int(SceneDocument&)> change;
  int maxLength = 0;  // 0: as asked for
  CoordinatePlacement placement = CoordinatePlacement::kDrawn;
};

// Those there are. A further one is a line in the list behind this.
std::span<const Variation> stressVariations();

// The variations that `names` ask for, in the list's order: whole names, or what stands before "=".
// All of them if there are no names. Throws std::invalid_argument, saying what there is, for an unknown
// one.
std::vector<const Variation*> chooseVariations(const std::vector<std::string>& names);

// The scene file's variation; nothing if it changes nothing there. `settings` are adapted to it. Throws
// what readScene throws.
std::optional<Scene> makeVariation(const std::string& file, const ReadOptions& options,
                                   const Variation& variation, StressSettings& settings);

// What came of one.
struct VariationOutcome {
  const Variation* variation = nullptr;
  bool applies = true;  // it changes something in this scene
  std::string error;    // it could not be read or rendered; a defect
  StressFindings findings;
  double seconds = 0;

  bool failed() const { return !error.empty() || (applies && findings.failed()); }
};

// Never throws for what goes wrong in a variation: that is its outcome.
VariationOutcome runVariation(const std::string& file, const ReadOptions& options,
                              const Variation& variation, StressSettings settings);

}  // namespace h2mc
