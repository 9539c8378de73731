// SPDX-License-Identifier: MIT
#include "mcmc/chain/kernel_mixture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "render/core/archive.h"

namespace h2mc {
namespace {

// More kernels than any mixture has: shares at a state are reckoned on the stack.
constexpr std::size_t kMost = 32;

}  // namespace

std::vector<std::string> KernelMixture::kindNames() const {
  std::vector<std::string> names{std::string(large->name())};
  for (const Small& s : small) names.emplace_back(s.mutation->name());
  return names;
}

Division KernelMixture::division() const {
  if (level) return {*level};
  const double mean = meanTarget.value_or(0);
  if (!held_.empty()) return {(largeProbability + baseSamples) * mean, held_.data(), mean};
  // Before anything is learned chains of a brief render have not forgotten where they began: what is bright is left to
  // the samples. Otherwise, beside base samples, what is found on most scenes.
  constexpr double kHeldAtFirst = 64, kHeld = 2;
  if (brief && learned_.empty()) return {kHeldAtFirst * (largeProbability + baseSamples) * mean};
  return {(largeProbability + kHeld * baseSamples) * mean};
}

void KernelMixture::sharesAt(const Path& state, double* shares) const {
  const std::size_t count = small.size();
  assert(count <= kMost);
  // What those that apply are given; of it, what those that learn have together.
  double sum = 0, together = 0, learned = 0;
  const bool learns = !learned_.empty();
  const std::size_t ofState = learns ? octaveRow(octave(state.target)) : 0;
  for (std::size_t k = 0; k < count; ++k) {
    const bool applies = small[k].mutation->applies(state);
    shares[k] = applies ? small[k].share : 0;
    sum += shares[k];
    if (!applies || !learns || !small[k].cost) continue;
    together += shares[k];
    shares[k] = learned_[k][ofState];
    learned += shares[k];
  }
  if (!(sum > 0)) return;
  for (std::size_t k = 0; k < count; ++k)
    if (shares[k] > 0) shares[k] *= learns && small[k].cost ? together / (learned * sum) : 1 / sum;
}

std::optional<KernelMixture::Choice> KernelMixture::choose(const Path& state,
                                                           Random& random) const {
  if (random.uniform() < largeProbability) return Choice{0, largeProbability};
  double shares[kMost];
  sharesAt(state, shares);
  double u = random.uniform();
  std::optional<Choice> choice;  // the last that applies, should rounding leave something
  for (std::size_t k = 0; k < small.size(); ++k) {
    if (!(shares[k] > 0)) continue;
    choice = {k + 1, (1 - largeProbability) * shares[k]};
    u -= shares[k];
    if (u < 0) break;
  }
  return choice;
}

double KernelMixture::probability(std::size_t kind, const Path& state) const {
  if (kind == 0) return largeProbability;
  double shares[kMost];
  sharesAt(state, shares);
  return (1 - largeProbability) * shares[kind - 1];
}

double KernelMixture::logRatio(const Choice& choice, const Path& proposed) const {
  if (choice.kind == 0) return 0;
  const double back = probability(choice.kind, proposed);
  return back == choice.probability ? 0 : std::log(back / choice.probability);
}

void KernelMixture::learn(const ChainStatistics& statistics) {
  // So many proposals with the acceptance that the kernel has over all octaves are added to each.
  constexpr double kPrior = 50;
  std::vector<std::vector<double>> shares(small.size());
  std::vector<double> totals(kOctaves, 0);
  int learners = 0;
  for (std::size_t k = 0; k < small.size(); ++k) {
    small[k].mutation->learn(statistics, k + 1);
    if (!small[k].cost) continue;
    ++learners;
    const std::vector<AcceptanceCount>& counts = statistics.octaves[k + 1];
    AcceptanceCount all;
    for (const AcceptanceCount& count : counts) all.add(count);
    const double mean = (all.expected + 1) / (static_cast<double>(all.proposed) + 1);
    for (std::size_t l = 0; l < counts.size(); ++l) {
      const double acceptance =
          (counts[l].expected + kPrior * mean) / (static_cast<double>(counts[l].proposed) + kPrior);
      const double efficiency = acceptance / *small[k].cost;
      shares[k].push_back(squared(squared(efficiency)));
      totals[l] += shares[k][l];
    }
  }
  large->learn(statistics, 0);
  for (auto& ofKernel : shares)
    for (std::size_t l = 0; l < ofKernel.size(); ++l)
      ofKernel[l] = kLeast + (1 - kLeast * learners) * ofKernel[l] / totals[l];
  learned_ = std::move(shares);
  if (!dividesByHolding || !meanTarget) return;
  held_.assign(kOctaves, 1);
  for (std::size_t l = 0; l < kOctaves; ++l) {
    long long mutations = 0;
    for (const auto& ofKind : statistics.octaves) mutations += ofKind[l].proposed;
    held_[l] = heldFor(mutations, statistics.departures[l]);
  }
}

void KernelMixture::archive(Archive& archive) {
  archive(meanTarget, baseSamples, brief, learned_, held_);
  for (int kind = 0; kind < kinds(); ++kind) mutation(at(kind)).archive(archive);
}

}  // namespace h2mc
