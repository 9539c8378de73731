// SPDX-License-Identifier: MIT
#include "mcmc/mutations/step_sizes.h"

#include <algorithm>
#include <cmath>

#include "render/core/archive.h"

namespace h2mc {

void StepSizes::learn(const std::vector<AcceptanceCount>& counts) {
  if (!(wanted_ > 0)) return;
  // Acceptance falls by a quarter at most where the step grows by e: with four times that its size is met at once where
  // the epochs' noise allows it. Half of it goes there in few epochs and does not swing.
  constexpr double kGain = 2;
  // Fewer proposals than this say too little.
  constexpr long long kLeast = 400;
  factors_.resize(counts.size(), 1);
  seen_.resize(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const long long proposed = counts[i].proposed - seen_[i].proposed;
    if (proposed < kLeast) continue;
    const double acceptance =
        (counts[i].expected - seen_[i].expected) / static_cast<double>(proposed);
    seen_[i] = counts[i];
    const double factor = double(factors_[i]) * std::exp(kGain * (acceptance - wanted_));
    factors_[i] = std::clamp(static_cast<float>(factor), 1 / kLargest, kLargest);
  }
}

void StepSizes::archive(Archive& archive) { archive(factors_, seen_); }

}  // namespace h2mc
