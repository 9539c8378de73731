// SPDX-License-Identifier: MIT
// Where chains start, and how bright the image is: bidirectional path tracing over the whole film.
#pragma once

#include <atomic>
#include <span>
#include <stdexcept>
#include <string>

#include "mcmc/chain/statistics.h"
#include "mcmc/mutations/technique_distribution.h"
#include "mcmc/targets/target.h"

namespace h2mc {

class Ranks;

// A replayed bootstrap sample did not give the luminance that the bootstrap saw: the two ways of
// tracing disagree, and no chain may start. A bug in the renderer, never bad input.
class ReplayError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

class Bootstrap {
 public:
  // Traces `samples` bidirectional samples of path lengths minLength .. maxLength; sample i draws
  // from Random(seed, its own stream, i). The same result for any number of threads. Once `stop` is set,
  // if it is given, no more samples are begun; some there are always. Ranks share out the samples: throws RankLost.
  Bootstrap(const Scene& scene, int minLength, int maxLength, long long samples, std::uint64_t seed,
            int threads, const std::atomic<bool>* stop = nullptr, Ranks* ranks = nullptr);
  // The same as if it had been made with so many; with fewer than there are, nothing. Throws RankLost.
  void extendTo(long long samples);

  // Luminance of a whole sample: its mean is the film's mean luminance (of these path lengths).
  const Moments& luminance() const { return luminance_; }
  // Mean luminance by technique, and the mean square; in the order of TechniqueDistribution.
  std::vector<double> techniqueLuminance() const { return perSample(techniqueSum_); }
  std::vector<double> techniqueSquares() const { return perSample(techniqueSquareSum_); }
  // Contributions that were not finite and are left out, and what replays the first of them (pathText).
  long long notFinite() const { return notFinite_; }
  const std::string& firstNotFinite() const { return firstNotFinite_; }

  // What the first half of the samples has of the luminance of all: in [0, 1].
  double firstHalf() const;

  // A path drawn in proportion to its target, evaluated: the sample that u, in [0, 1), falls on where
  // all lie side by side, and one of its techniques. Precondition: luminance().mean() > 0. Throws
  // ReplayError.
  void drawStart(double u, Random& random, Path& start) const;

 private:
  struct Block;
  // Samples from number `first` on, as many as `luminances` has room for.
  void trace(Block& block, long long first, std::span<double> luminances) const;
  std::vector<double> perSample(std::vector<double> sums) const;

  const Scene& scene_;
  int minLength_, maxLength_;
  std::uint64_t seed_;
  int threads_;
  const std::atomic<bool>* stop_;
  Ranks* ranks_;
  std::vector<double> cumulative_;  // of the samples' luminances
  Moments luminance_;
  std::vector<double> techniqueSum_, techniqueSquareSum_;
  long long notFinite_ = 0;
  std::string firstNotFinite_;
};

}  // namespace h2mc
