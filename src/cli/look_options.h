// SPDX-License-Identifier: MIT
// Options that several commands have of pictures: how they are shown, and what they hold beside light.
#pragma once

#include <string>
#include <vector>

#include "render/image/layer.h"
#include "render/image/tone_mapping.h"

namespace CLI {
class App;
}

namespace h2mc {

// --exposure and --tonemap, as they are given.
struct LookOptions {
  std::string exposure, curve;
  bool given() const { return !exposure.empty() || !curve.empty(); }
};
void addLookOptions(CLI::App& command, LookOptions& options);
// Throws InputError.
ToneMapping toneMapping(const LookOptions& options);

// The kinds of --aov's names, without repetition. Throws InputError.
std::vector<LayerKind> layerKinds(const std::vector<std::string>& names);
// All names, for messages.
std::vector<std::string> layerKindNames();

}  // namespace h2mc
