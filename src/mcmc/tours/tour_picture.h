// SPDX-License-Identifier: MIT
// The picture that tours make.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "mcmc/chain/chain_films.h"
#include "mcmc/render/noise.h"
#include "render/integrator/pixel_statistics.h"

namespace h2mc {

// The sum of all samples' splats, and that of either half of the samples, which have nothing in common: in measured
// rows, and of every pixel where its variance is asked for. Memory: 24 bytes a pixel, 24 more with variances and 24
// with counts.
class TourPicture {
 public:
  // `threads`: to add up on; what comes out does not depend on it. `weight`: of each splat.
  TourPicture(const FilmSettings& settings, int threads, double weight, PixelStatistics statistics);

  // What a group has left in a round, for half 0 or 1.
  struct Part {
    ChainFilms* films;
    int half;
    long long samples;
  };
  // To be called by each group when it has made its part, before all of them are added.
  void sort(ChainFilms& films) const;
  // Adds the parts in their order and empties them.
  void add(std::span<const Part> parts);
  void archive(Archive& archive);

  Image image() const;
  // By either half, in the measured rows, as of so many mutations a sample.
  TwoEstimates halves(double mutationsASample) const;
  // Of the picture, where it was asked for: from its halves.
  Image variance() const;
  // How many mutations have landed on each pixel, where that was asked for.
  std::vector<float> counts() const;

 private:
  double scale(double samples) const { return samples > 0 ? weight_ / samples : 0; }
  double samples() const { return samples_[0] + samples_[1]; }

  int threads_;
  double weight_;
  Film film_;
  std::optional<Film> first_;  // of half 0
  std::optional<Film> landed_;
  std::array<double, 2> samples_{};
};

}  // namespace h2mc
