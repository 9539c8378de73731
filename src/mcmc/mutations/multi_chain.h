// SPDX-License-Identifier: MIT
// The multi-chain perturbation: for light that is seen through smooth surfaces on rough ones beyond which there are
// further smooth ones, such as a pool's floor.
#pragma once

#include "mcmc/mutations/camera_perturbation.h"

namespace h2mc {

class MultiChain : public CameraPerturbation {
 public:
  // Keeps references.
  MultiChain(const PathTarget& target, float threshold, SlotNumbers& slots)
      : CameraPerturbation(target, threshold, true, slots) {}
  std::string_view name() const override { return "multiChain"; }
  // Where there is a rough vertex to turn the direction at.
  bool applies(const Path& path) const override {
    int rough;
    reconnection(path, path.technique.length(), rough);
    return rough > 0;
  }
};

MutationPlugin multiChain();

}  // namespace h2mc
