// SPDX-License-Identifier: MIT
// Checkpoints: the state of a render in a file, to go on from.
#pragma once

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "render/core/archive.h"
#include "render/integrator/integrator.h"

namespace h2mc {

class Checkpoint {
 public:
  // identity: identityOf(...).
  Checkpoint(std::string file, nlohmann::json identity)
      : file_(std::move(file)), identity_(std::move(identity)) {}

  const std::string& file() const { return file_; }
  bool exists() const;
  // Opens the file and returns where to read a render's state from, which lives as long as this does. Throws InputError
  // if it is damaged or no checkpoint, or one of another render: then the message says what differs.
  Archive& open();
  // Whether the render whose state it is has kept its variance for who looks on. That decides on the state, but not on
  // the picture: who goes on from it keeps to it. Of open()'s file, unless it was set.
  bool keepsVariance() const { return keepsVariance_; }
  void setKeepsVariance(bool keeps) { keepsVariance_ = keeps; }
  // Replaces the file, whole or not at all. Throws std::runtime_error, what() being the whole message.
  void save(RenderInProgress& render) const;

 private:
  std::string file_;
  nlohmann::json identity_;
  bool keepsVariance_ = false;
  std::ifstream stream_;
  std::unique_ptr<Archive> archive_;
};

}  // namespace h2mc
