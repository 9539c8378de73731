// SPDX-License-Identifier: MIT
// Step sizes that follow acceptance.
#pragma once

#include <vector>

#include "mcmc/chain/statistics.h"

namespace h2mc {

class Archive;

// A factor on a mutation's step size for each path length, by which so much is accepted as is wanted [Hachisuka and
// Jensen 2011, "Robust Adaptive Photon Tracing Using Photon Path Visibility", section 4.2; Zsolnai and Szirmay-Kalos
// 2013, "Automatic Parameter Control for Metropolis Light Transport"]. Between two calls of learn() it is a function of
// the length alone, which such a step keeps: steps stay symmetric.
class StepSizes {
 public:
  // wanted: acceptance, in (0, 1); 0: all factors stay 1.
  explicit StepSizes(double wanted) : wanted_(wanted) {}

  float of(int length) const {
    const auto i = static_cast<std::size_t>(length);
    return i < factors_.size() ? factors_[i] : 1;
  }
  // counts: by length, all that was proposed so far.
  void learn(const std::vector<AcceptanceCount>& counts);
  void archive(Archive& archive);

  static constexpr float kLargest = 32;  // and its reciprocal: of all factors

 private:
  double wanted_;
  std::vector<float> factors_;         // by length; empty before learn()
  std::vector<AcceptanceCount> seen_;  // at the last learn()
};

}  // namespace h2mc
