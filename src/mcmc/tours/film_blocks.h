// SPDX-License-Identifier: MIT
// How bright the parts of a film are, with errors from independent estimates.
#pragma once

#include <vector>

#include "mcmc/chain/statistics.h"
#include "render/image/film.h"
#include "render/integrator/splat_list.h"

namespace h2mc {

// Mean luminance of the film and of each of its blocks. Splats count where they land, whatever the film's filter.
class BlockMoments {
 public:
  static constexpr int kColumns = 8, kRows = 6;

  BlockMoments();
  // One estimate: `scale` times the sum of the splats. Sorts them for a film of its own.
  void add(SplatList& splats, double scale);
  void add(const BlockMoments& other);
  void archive(Archive& archive);

  const Moments& whole() const { return whole_; }
  const Moments& block(int column, int row) const { return blocks_[at(row * kColumns + column)]; }
  // Means and standard errors row by row, in units of `unit`.
  nlohmann::json json(double unit) const;

 private:
  std::vector<Moments> blocks_;
  Moments whole_;
  Film film_;
};

}  // namespace h2mc
