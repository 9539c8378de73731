// SPDX-License-Identifier: MIT
#include "mcmc/mutations/technique_distribution.h"

#include <algorithm>

namespace h2mc {

TechniqueDistribution::TechniqueDistribution(int minLength, int maxLength) : minLength_(minLength) {
  for (int length = minLength; length <= maxLength; ++length)
    for (int s = 0; s <= length; ++s) techniques_.push_back({s, length + 1 - s});
  setWeights(std::vector<double>(techniques_.size(), 1),
             std::vector<bool>(techniques_.size(), true));
}

int TechniqueDistribution::index(const Technique& technique) const {
  // Length l has l + 1 techniques.
  const int length = technique.length();
  return (length * (length + 1) - minLength_ * (minLength_ + 1)) / 2 + technique.s;
}

void TechniqueDistribution::setWeights(const std::vector<double>& weights,
                                       const std::vector<bool>& possible) {
  constexpr double kEvenShare = 0.1;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (techniques_[i] == Technique{1, 1} || !possible[i]) continue;
    sum += weights[i];
    count += 1;
  }
  probabilities_.assign(weights.size(), 0);
  cumulative_.assign(weights.size(), 0);
  double total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (techniques_[i] != Technique{1, 1} && possible[i]) {
      const double even = 1 / count;
      probabilities_[i] = sum > 0 ? kEvenShare * even + (1 - kEvenShare) * weights[i] / sum : even;
    }
    cumulative_[i] = total += probabilities_[i];
  }
}

int TechniqueDistribution::choose(float u) const {
  const auto found =
      std::upper_bound(cumulative_.begin(), cumulative_.end(), u * cumulative_.back());
  return static_cast<int>(std::min(found, cumulative_.end() - 1) - cumulative_.begin());
}

}  // namespace h2mc
