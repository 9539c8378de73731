#include "mcmc/kernel_mixture.h"

#include <algorithm>
#include <cmath>

namespace h2mc {

std::vector<std::string> KernelMixture::kindNames() const {
  std::vector<std::string> names{std::string(large->name())};
  for (const Small& s : small) names.emplace_back(s.mutation->name());
  return names;
}

int KernelMixture::level(double target) const {
  if (!(brightness > 0)) return 0;
  return std::clamp(std::ilogb(target / brightness), -kHighestLevel, kHighestLevel);
}

double KernelMixture::smallShare(std::size_t k, const Technique& technique, int level) const {
  const auto given = [&](const Small& s) {
    return technique.t >= 2 ? s.cameraShare : s.lightShare;
  };
  if (!(small[k].cost > 0) || learned_.empty()) return given(small[k]);
  double together = 0;
  for (const Small& s : small)
    if (s.cost > 0) together += given(s);
  return together * learned_[k][at(level)];
}

std::size_t KernelMixture::choose(const Path& state, Random& random) const {
  if (random.uniform() < largeProbability) return 0;
  const int ofState = level(state.target);
  double u = random.uniform();
  std::size_t kind = 1;
  for (; kind < small.size(); ++kind) {
    u -= smallShare(kind - 1, state.technique, ofState);
    if (u < 0) break;
  }
  return kind;
}

double KernelMixture::logRatio(std::size_t kind, const Path& current, const Path& proposed) const {
  if (kind == 0 || !(small[kind - 1].cost > 0) || learned_.empty()) return 0;
  const int from = level(current.target), to = level(proposed.target);
  return from == to ? 0 : std::log(learned_[kind - 1][at(to)] / learned_[kind - 1][at(from)]);
}

void KernelMixture::learn(const ChainStatistics& statistics) {
  // So many proposals with the acceptance that the kernel has over all levels are added to each.
  constexpr double kPrior = 50;
  std::vector<std::vector<double>> shares(small.size());
  std::vector<double> totals(2 * kHighestLevel + 1, 0);
  int learners = 0;
  for (std::size_t k = 0; k < small.size(); ++k) {
    if (!(small[k].cost > 0)) continue;
    ++learners;
    const std::vector<AcceptanceCount>& counts = statistics.levels[k + 1];
    AcceptanceCount all;
    for (const AcceptanceCount& count : counts) all.add(count);
    const double mean = (all.expected + 1) / (static_cast<double>(all.proposed) + 1);
    for (std::size_t l = 0; l < counts.size(); ++l) {
      const double acceptance =
          (counts[l].expected + kPrior * mean) / (static_cast<double>(counts[l].proposed) + kPrior);
      const double efficiency = acceptance / small[k].cost;
      shares[k].push_back(squared(squared(efficiency)));
      totals[l] += shares[k][l];
    }
  }
  for (auto& ofKernel : shares)
    for (std::size_t l = 0; l < ofKernel.size(); ++l)
      ofKernel[l] = kLeast + (1 - kLeast * learners) * ofKernel[l] / totals[l];
  learned_ = std::move(shares);
}

}  // namespace h2mc
