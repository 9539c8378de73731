// SPDX-License-Identifier: MIT
// Options that several commands have of pictures: how they are shown.
#pragma once

#include <string>

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

}  // namespace h2mc
