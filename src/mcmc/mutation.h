// States and the kernels that move between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "mcmc/gaussian.h"
#include "mcmc/target.h"
#include "render/image/film.h"

namespace h2mc {

// A chain's state: a path with what has been derived from it so far. What is derived is a function
// of the path alone, made on first use and kept until the path changes.
struct ChainState {
  explicit ChainState(int maxLength) : path(maxLength) {}

  Path path;
  bool hasGaussian = false;
  Gaussian gaussian;
  bool hasLens = false;
  Gaussian lens;  // over film positions
  double bidirectional =
      0;  // luminance of a whole bidirectional sample around the path; 0: unknown

  // The path is about to change.
  void forget() {
    hasGaussian = hasLens = false;
    bidirectional = 0;
  }
};

// How often derivatives were wanted and what came of it.
struct DerivativeCounts {
  long long steps = 0;  // that ask for them at the state and at the proposal
  long long dark = 0;   // proposals without a contribution, where none are needed
  long long kept = 0;   // were there already
  long long computed = 0;
  long long inDouble = 0;   // of these, where float would not do
  long long flat = 0;       // too small to matter against the prior: no eigendecomposition
  long long notFinite = 0;  // the prior took their place

  void add(const DerivativeCounts& other);
  nlohmann::json json() const;
};

// Seconds that sampled mutations spent in each part; see Profile.
struct PhaseSeconds {
  double derivatives = 0, gaussian = 0;
};

// What a mutation works with; one a group of chains.
struct MutationContext {
  Random* random = nullptr;
  DerivativeCounts derivatives;
  PhaseSeconds seconds;
  bool timed = false;  // this mutation's phases are measured
};

// A film, and the sum of the luminances splatted on it.
struct SummedFilm {
  Film film;
  double luminance = 0;

  void splat(float filmX, float filmY, const Rgbf& value) {
    film.splat(filmX, filmY, value);
    luminance += h2mc::luminance(value);
  }
  void merge(const SummedFilm& other) {
    film.merge(other.film);
    luminance += other.luminance;
  }
  void clear() {
    film.clear();
    luminance = 0;
  }
};

// A proposal kernel. It makes proposals and says their densities; acceptance, splatting and
// statistics are the chain's.
class Mutation {
 public:
  virtual ~Mutation() = default;
  virtual std::string_view name() const = 0;

  // Proposes `proposed` from `current` and evaluates it. False when nothing was proposed or the
  // target is zero there: the proposal is then rejected. Otherwise `logRatio` is
  // log q(proposed -> current) - log q(current -> proposed), with respect to the primary measure of
  // all techniques' spaces together. `current` changes only in what is derived from it.
  virtual bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
                       double& logRatio) = 0;

  // Adds the last proposal to a film, with the probability of its acceptance as weight: the path's
  // contribution over its target and `shared` (see KernelMixture). A mutation that knows what else
  // it might as well have proposed adds the average of that.
  virtual void splatProposal(const ChainState& proposed, double weight, double shared,
                             SummedFilm& film) const {
    splatPath(proposed.path, weight, shared, film);
  }

  static void splatPath(const Path& path, double weight, double shared, SummedFilm& film) {
    film.splat(path.filmX, path.filmY,
               path.contribution * static_cast<float>(weight / (path.target + shared)));
  }
};

// Metropolis-Hastings: the probability with which a proposal is accepted that Mutation::propose made,
// with the logRatio that it gave. In [0, 1]. Precondition: from.target > 0.
inline double acceptanceProbability(const Path& from, const Path& to, double logRatio) {
  const double ratio = double(to.target) / from.target * std::exp(logRatio);
  return std::isfinite(ratio) ? std::min(1.0, ratio) : (ratio > 0 ? 1.0 : 0.0);
}

}  // namespace h2mc
