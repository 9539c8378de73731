// SPDX-License-Identifier: MIT
// The lens perturbation with Veach's radial law.
#pragma once

#include "mcmc/mutations/camera_perturbation.h"

namespace h2mc {

class VeachLens final : public CameraPerturbation {
 public:
  VeachLens(const PathTarget& target, float threshold, SlotNumbers& slots)
      : CameraPerturbation(target, threshold, false, slots) {}
  std::string_view name() const override { return "veachLens"; }
};

MutationPlugin veachLens();

}  // namespace h2mc
