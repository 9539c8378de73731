// SPDX-License-Identifier: MIT
#include "cli/keeper.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Seconds between two checkpoints: where one is asked for, and where nobody has.
constexpr double kAsked = 60, kUnasked = 300;

}  // namespace

void addKeepOptions(CLI::App& command, KeepOptions& options) {
  const auto seconds = CLI::Range(0.0, 1e9);
  command
      .add_option("--checkpoint", options.checkpoint,
                  "File for the render's state, from which --resume goes on. Default: the "
                  "image's name with .checkpoint, written after five minutes and removed at "
                  "the end")
      ->type_name("FILE");
  command
      .add_option("--every", options.every,
                  "Seconds between two checkpoints; 0: none. Default: 60 with --checkpoint, else "
                  "300")
      ->check(seconds);
  command.add_flag("--resume", options.resume,
                   "Go on from the checkpoint, if there is one. The budget is that of both "
                   "together and may be larger than before");
  command.add_option("--save-every", options.saveEvery, "Seconds between two images on the way")
      ->check(seconds);
}

std::string checkpointFile(const KeepOptions& options, const std::string& image) {
  if (!options.checkpoint.empty()) return options.checkpoint;
  return std::filesystem::path(image).replace_extension(".checkpoint").string();
}

Keeper::Keeper(const KeepOptions& options, Checkpoint checkpoint,
               std::function<void(const RenderResult&)> saveImage, Ranks* ranks)
    : options_(options),
      checkpoint_(std::move(checkpoint)),
      saveImage_(std::move(saveImage)),
      ranks_(ranks),
      every_(options.every.value_or(asked() ? kAsked : kUnasked)),
      began_(wallClock()),
      lastState_(began_),
      lastImage_(began_) {}

Archive* Keeper::resume() {
  if (!options_.resume) {
    if (checkpoint_.exists())
      spdlog::warn("\"{}\" is there: --resume would go on from it", checkpoint_.file());
    return nullptr;
  }
  if (!checkpoint_.exists()) {
    spdlog::warn("there is no checkpoint \"{}\": from the beginning", checkpoint_.file());
    return nullptr;
  }
  Archive& archive = checkpoint_.open();
  saved_ = true;
  return &archive;
}

bool Keeper::keepsVariance(bool want) {
  if (!saved_) checkpoint_.setKeepsVariance(want);
  return checkpoint_.keepsVariance();
}

bool Keeper::isDue(const RenderInProgress& render) const {
  if (!(every_ > 0) || savedLast_) return false;
  if (render.isOver() && !stopped()) return asked();
  if (!render.isExact()) return false;
  const double now = wallClock();
  // Nobody wants a checkpoint of a short render.
  if (stopped()) return asked() || saved_ || now - began_ >= every_;
  return now - lastState_ >= every_;
}

bool Keeper::imageIsDue(const RenderInProgress& render) const {
  return options_.saveEvery > 0 && !render.isOver() &&
         wallClock() - lastImage_ >= options_.saveEvery;
}

void Keeper::look(RenderInProgress& render) {
  struct Due {
    bool state, image;
  };
  Due due{isDue(render), imageIsDue(render)};
  // All ranks bring together what the first one is to write. Where one is lost there is nothing more to write.
  try {
    due = agreed(ranks_, due);
    if (due.state || due.image) render.gather();
  } catch (const RankLost&) {
    return;
  }
  if (due.state) saveState(render);
  if (due.image) saveImage(render);
}

void Keeper::saveState(RenderInProgress& render) {
  try {
    if (!ranks_ || ranks_->isFirst()) render.pause([&] { checkpoint_.save(render); });
    saved_ = true;
    savedLast_ = stopped();
  } catch (const std::exception& e) {
    spdlog::warn("{}", e.what());
  }
  lastState_ = wallClock();
}

void Keeper::saveImage(RenderInProgress& render) {
  if (!ranks_ || ranks_->isFirst())
    render.pause([&] {
      const RenderResult result = render.result();
      if (result.samples > 0 || result.meanLuminance > 0) saveImage_(result);
    });
  lastImage_ = wallClock();
}

void Keeper::finish(bool interrupted) {
  if (!saved_) return;
  if (interrupted) {
    spdlog::warn("the same command with --resume goes on from \"{}\"", checkpoint_.file());
  } else if (!asked()) {
    std::error_code error;
    std::filesystem::remove(checkpoint_.file(), error);
  }
}

}  // namespace h2mc
