// SPDX-License-Identifier: MIT
// The picture that chains make.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "mcmc/chain/chain_films.h"
#include "mcmc/render/noise.h"
#include "render/core/zeroed_array.h"
#include "render/integrator/pixel_statistics.h"

namespace h2mc {

// The image as an estimate from the chains' states and from independent samples (large steps, base samples), over
// stretches of mutations with one target each. A stretch ends with its epoch or, so that floats do to add up in, after
// a thousand mutations a pixel.
//
// With target f of mean b over the primary spaces, contribution C with filter h, the samples' density p and a
// Division's level s, a pixel is the sum of
//
//     I = integral of h C f / (f + s p)  +  integral of h C s p / (f + s p).
//
// The states of n mutations, distributed as f / b, estimate the first by b / n times the sum of h C / (f + s p); the
// N samples estimate the second by 1 / N times the sum of h C s / (f + s p). As for b: the luminance of all paths
// is L = integral of luminance(C) = b E[luminance(C) / f] over the states, so that b = L / m, m being the states' mean
// of luminance(C) / f and L known from the bootstrap and all samples. m is 1 without an importance map.
// Nothing is subtracted: where C and h are not negative no pixel is.
//
// Variance is told from the pictures that the two halves of the chains make by themselves in all stretches, so that it
// knows how long chains take to forget.
//
// Memory: 48 bytes a pixel, 24 of them only between begin() and end(), and up to 9 MB. With variances twice as much,
// with counts 24 bytes more.
class ImageEstimate {
 public:
  // `threads`: to add up on; 0: one a core. What comes out does not depend on it.
  ImageEstimate(const FilmSettings& settings, int threads, PixelStatistics statistics = {});

  // What a group has left in a round.
  struct Part {
    ChainFilms* films;
    int half;  // 0 or 1
    long long mutations, samples;
  };
  // To be called by each group when it has made its part, before all of them are added.
  void sort(ChainFilms& films) const;
  // Adds the parts in their order and empties them.
  void add(std::span<const Part> parts);

  // Begins an epoch; ends it, which keeps only its picture. add() and halves() are for between the two.
  void begin();
  void end();

  // All that was added, between two rounds.
  void archive(Archive& archive);

  // The picture so far, if the mean luminance is known to be this.
  Image image(double luminance) const;
  // The present epoch's picture by either half, in the measured rows.
  TwoEstimates halves(double luminance) const;
  // What of it is by states, and what by samples, as numbers of which these are counted.
  TwoEstimates stateHalves(double luminance) const;
  TwoEstimates sampleHalves() const;
  // Of that picture, the mean luminance having this standard error; where it was asked for. The square of the picture
  // where one of the halves has made nothing.
  Image variance(double luminance, double luminanceError) const;
  // How many mutations have landed on each pixel, each shared between where it was and what it proposed; where that was
  // asked for.
  std::vector<float> counts() const;

 private:
  struct Sums {
    double mutations = 0, samples = 0;
    double overTarget = 0;
    // By what the sums of either film are to be multiplied to be `mutations` times what they estimate, the states' for
    // a mean luminance of 1.
    double ofStates() const { return overTarget > 0 ? mutations / overTarget : 0; }
    double ofSamples() const { return samples > 0 ? mutations / samples : 0; }
  };
  // What half 0 makes of the present stretch, and by how much its picture is above the other half's in past ones, each
  // as the sums of all are kept.
  struct Apart {
    explicit Apart(const FilmSettings& settings, std::size_t pixels)
        : statesFilm(settings), samplesFilm(settings), states(pixels), samples(pixels) {}
    ShortFilm statesFilm, samplesFilm;
    std::array<Sums, 2> stretch;
    ZeroedArray<Rgbf> states, samples;
    std::array<double, 2> mutations{};  // of all stretches
    void archive(Archive& archive);
  };
  struct Difference {
    Rgbf states, samples;
  };
  // Of the present stretch at a pixel.
  Difference differenceAt(int x, int y) const;
  void endStretch();
  // All that are emptied with a stretch.
  std::vector<ShortFilm*> films();
  double pixels() const;

  // Calls work(y, i) for every row y, whose first pixel is number i, in parallel.
  void forEachRow(const std::function<void(int y, std::size_t i)>& work) const;

  FilmSettings settings_;
  int threads_;
  ShortFilm statesFilm_, samplesFilm_;
  Sums stretch_;               // on the films
  std::array<Sums, 2> epoch_;  // of the films' halves
  std::optional<Apart> apart_;
  std::optional<Film> landed_;
  // Past stretches, summed with their number of mutations as weights: states for a mean luminance of 1, and
  // samples.
  ZeroedArray<Rgbf> states_, samples_;
  double mutations_ = 0;
};

}  // namespace h2mc
