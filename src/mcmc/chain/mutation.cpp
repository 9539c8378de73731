// SPDX-License-Identifier: MIT
#include "mcmc/chain/mutation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "render/core/archive.h"
#include "render/path/path_text.h"

namespace h2mc {

void NotFiniteCounts::add(const Technique& technique, const PrimarySample& sample,
                          long long times) {
  if (count == 0) first = pathText(technique, sample);
  count += times;
}

void NotFiniteCounts::add(const NotFiniteCounts& other) {
  if (first.empty()) first = other.first;
  count += other.count;
}

double Proposal::acceptance(const Path& from, const Path& to, double logSelection) const {
  assert(!isDecided() || logSelection == 0);
  if (!made()) return 0;
  if (isDecided()) return 1;
  const double ratio = double(to.target) / from.target * std::exp(logRatio_ + logSelection);
  return std::isfinite(ratio) ? std::min(1.0, ratio) : (ratio > 0 ? 1.0 : 0.0);
}

void NotFiniteCounts::archive(Archive& archive) { archive(count, first); }

}  // namespace h2mc
