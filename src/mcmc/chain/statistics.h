// SPDX-License-Identifier: MIT
// What a chain counts, and how it is told.
#pragma once

#include <algorithm>
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mcmc/chain/mutation.h"

namespace h2mc {

struct AcceptanceCount {
  long long proposed = 0;
  double expected = 0;  // sum of acceptance probabilities
  void add(double acceptance) {
    ++proposed;
    expected += acceptance;
  }
  void add(const AcceptanceCount& other) {
    proposed += other.proposed;
    expected += other.expected;
  }
};

// Mean and variance of independent estimates.
struct Moments {
  long long count = 0;
  double sum = 0, squares = 0;
  void add(double x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  void add(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
  double variance() const;       // of one estimate
  double standardError() const;  // of the mean
};

// Seconds of sampled mutations by what they went into.
struct Profile {
  long long mutations = 0;  // timed
  double total = 0, rays = 0, derivatives = 0, gaussian = 0;
  void add(const Profile& other);
};

// For how many of so many mutations a chain stays before it departs, at least 1. One that nobody has seen depart counts
// as one that is about to.
inline double heldFor(long long mutations, double departures) {
  return std::max(static_cast<double>(mutations) / (departures + 1), 1.);
}

// One group of chains' tallies, merged in the groups' order.
struct ChainStatistics {
  ChainStatistics(int mutationKinds, int maxLength);

  std::vector<std::vector<AcceptanceCount>> acceptance;  // [kind][path length]
  std::vector<std::vector<AcceptanceCount>> octaves;     // [kind][octaveRow(octave)]
  std::vector<double> departures;  // [octaveRow(octave)]: moves by more than a pixel, as expected
  std::vector<std::array<long long, kRefusals>> refusals;  // [kind][Refusal]: nothing proposed
  std::vector<std::vector<double>> sums;     // [kind]: what a mutation adds up to learn from
  std::vector<AcceptanceCount> secondTries;  // [kind]
  DerivativeCounts derivatives;
  Moments largeSteps;  // target over density: estimates of the mean luminance
  Profile profile;
  long long mutations = 0;
  NotFiniteCounts notFinite;  // contributions of proposals

  void add(const ChainStatistics& other);
  void archive(Archive& archive);
  nlohmann::json json(const std::vector<std::string>& kindNames) const;
};

}  // namespace h2mc
