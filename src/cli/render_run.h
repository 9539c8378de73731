// SPDX-License-Identifier: MIT
// A render of the command line, from its options to its files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/keeper.h"
#include "cli/live_view.h"
#include "cli/look_options.h"
#include "render/image/film_window.h"
#include "render/integrator/integrator.h"

namespace CLI {
class App;
}

namespace h2mc {

// The image that is rendered again, and what its header says of how it was made.
struct RenderedBefore {
  std::string image;  // empty: none is
  std::string sceneDigest, programVersion;
};

struct RenderOptions {
  std::string scene, output, integrator, statistics, confine;
  RenderBudget budget;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  int width = 0, height = 0;
  double scale = 0;
  std::optional<PixelRectangle> crop;
  std::vector<std::string> defines;
  std::vector<std::string> layers;  // names
  int layerSamples = 16;            // camera rays a pixel, for those that are made by such
  LookOptions look;
  KeepOptions keep;
  LiveOptions live;
  bool permissive = false;
  bool quiet = false, png = false;
  RenderedBefore again;
};

// The options --time, --samples-per-pixel and --mutations-per-pixel, in a group.
void addBudget(CLI::App& command, RenderBudget& budget, const std::string& description);
// Those that say where a render's results go and what it shows on the way, but for -o.
void addOutputOptions(CLI::App& command, RenderOptions& options);

// Renders, writes what was asked for, and returns the exit code. Throws InputError and other UserErrors.
int runRender(const RenderOptions& options);

}  // namespace h2mc
