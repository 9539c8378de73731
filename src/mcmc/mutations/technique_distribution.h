// SPDX-License-Identifier: MIT
// Which technique a large step proposes.
#pragma once

#include <vector>

#include "render/core/index.h"
#include "render/path/primary_sample.h"

namespace h2mc {

// Discrete probabilities over the techniques of lengths minLength .. maxLength.
class TechniqueDistribution {
 public:
  TechniqueDistribution(int minLength, int maxLength);

  // Probabilities in proportion to `weights` (one a technique, >= 0), with a share spread evenly
  // over those that can contribute, so that none is starved by a bad estimate. A technique is taken
  // to contribute nothing at all only if `possible` says so.
  void setWeights(const std::vector<double>& weights, const std::vector<bool>& possible);

  int size() const { return static_cast<int>(techniques_.size()); }
  const Technique& technique(int index) const { return techniques_[at(index)]; }
  int index(const Technique& technique) const;
  int choose(float u) const;
  double probability(int index) const { return probabilities_[at(index)]; }
  double probability(const Technique& technique) const { return probability(index(technique)); }

 private:
  int minLength_;
  std::vector<Technique> techniques_;
  std::vector<double> probabilities_, cumulative_;
};

}  // namespace h2mc
