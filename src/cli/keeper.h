// SPDX-License-Identifier: MIT
// What is written while a render goes on.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/checkpoint.h"
#include "cli/stop_signals.h"
#include "render/integrator/ranks.h"

namespace CLI {
class App;
}

namespace h2mc {

struct KeepOptions {
  std::string checkpoint;       // --checkpoint; empty: beside the image, for a long render
  std::optional<double> every;  // seconds between two checkpoints; 0: none
  double saveEvery = 0;         // seconds between two images; 0: none
  bool resume = false;
};
void addKeepOptions(CLI::App& command, KeepOptions& options);

// The checkpoint's file. `image`: what is rendered into.
std::string checkpointFile(const KeepOptions& options, const std::string& image);

// Writes images and checkpoints when it is time. What can't be written is a warning: the render goes on, and what was
// written before stands.
class Keeper {
 public:
  // saveImage writes the image so far. Of ranks, each of which has a keeper, the first one writes; null: there are
  // none.
  Keeper(const KeepOptions& options, Checkpoint checkpoint,
         std::function<void(const RenderResult&)> saveImage, Ranks* ranks);

  // Where to go on from; null: from the beginning. Throws InputError.
  Archive* resume();
  // To be called after resume(): whether the render keeps its variance for who looks on, if they `want` it. One that
  // goes on does what it did before.
  bool keepsVariance(bool want);
  // Whether RenderRequest::watch is wanted at all.
  bool wanted() const { return every_ > 0 || options_.saveEvery > 0; }
  void look(RenderInProgress& render);
  // The render's image was written. A checkpoint that nobody has asked for goes where the render is complete; of one
  // that was interrupted it is said that there is one.
  void finish(bool interrupted);

 private:
  bool stopped() const { return ranks_ ? ranks_->stop() : StopSignals::requested(); }
  bool asked() const { return !options_.checkpoint.empty(); }
  // Whether the state is to be written now, and the image.
  bool isDue(const RenderInProgress& render) const;
  bool imageIsDue(const RenderInProgress& render) const;
  void saveState(RenderInProgress& render);
  void saveImage(RenderInProgress& render);

  const KeepOptions options_;
  Checkpoint checkpoint_;
  std::function<void(const RenderResult&)> saveImage_;
  Ranks* ranks_;
  double every_;
  double began_, lastState_, lastImage_;
  bool saved_ = false;      // by this render, or what it has gone on from
  bool savedLast_ = false;  // since it was asked to stop
};

}  // namespace h2mc
