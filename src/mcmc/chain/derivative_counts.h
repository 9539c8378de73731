// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace h2mc {

// How often derivatives were wanted and what came of it.
struct DerivativeCounts {
  long long steps = 0;  // that ask for them at the state and at the proposal
  long long dark = 0;   // proposals without a contribution, where none are needed
  long long kept = 0;   // were there already
  long long computed = 0;
  long long inDouble = 0;   // of these, where float would not do
  long long flat = 0;       // too small to matter against the prior: no eigendecomposition
  long long notFinite = 0;  // the prior took their place

  void add(const DerivativeCounts& other);
  nlohmann::json json() const;
};

}  // namespace h2mc
