#include "mcmc/large_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace h2mc {

bool MultiplexedLargeStep::propose(ChainState& current, ChainState& proposed,
                                   MutationContext& context, double& logRatio) {
  Random& random = *context.random;
  const int index = techniques_.choose(random.uniform());
  Path& path = proposed.path;
  path.technique = techniques_.technique(index);
  path.sample.time = target_.hasTime() ? random.uniform() : 0;
  for (int i = 0; i < path.technique.dimension(); ++i)
    path.sample.u[static_cast<std::size_t>(i)] = random.uniform();
  for (int i = 0; i < path.technique.choices(); ++i)
    path.sample.choice[static_cast<std::size_t>(i)] = random.uniform();
  lastEstimate_ = 0;
  if (!target_.evaluate(path)) return false;
  lastEstimate_ = luminance(path.contribution) / techniques_.probability(index);
  logRatio =
      std::log(techniques_.probability(current.path.technique) / techniques_.probability(index));
  return true;
}

void MultiplexedLargeStep::splatSample(const ChainState& proposed, double share,
                                       SummedFilm& film) const {
  const Path& path = proposed.path;
  const double shared = share * techniques_.probability(path.technique);
  film.splat(path.filmX, path.filmY,
             path.contribution * static_cast<float>(share / (path.target + shared)));
}

bool BidirectionalLargeStep::propose(ChainState& current, ChainState& proposed,
                                     MutationContext& context, double& logRatio) {
  const Scene& scene = target_.scene();
  Random& random = *context.random;
  connections_.clear();
  lastEstimate_ = 0;
  double sum = 0;
  sampler_.sample(scene, random, -1, -1, minLength_,
                  [&](const BidirectionalSampler::Connection& c) {
                    connections_.push_back({c, target_.target(c)});
                    sum += connections_.back().target;
                    lastEstimate_ += luminance(c.contribution);
                  });
  if (!(sum > 0)) return false;
  double u = random.uniformDouble() * sum;
  std::size_t picked = 0;
  while (picked + 1 < connections_.size() && (u -= connections_[picked].target) >= 0) ++picked;
  Path& path = proposed.path;
  const BidirectionalSampler::Connection& chosen = connections_[picked].connection;
  path.technique = chosen.technique;
  path.sample = sampler_.primarySample(path.technique);
  path.target = static_cast<float>(connections_[picked].target);
  path.filmX = chosen.filmX;
  path.filmY = chosen.filmY;

  // Whether it is accepted is decided here, by its own random number: W is at least the present path's
  // target, so that most of what is rejected needs no other connections of the present sample, and only
  // what is accepted is traced.
  const double threshold = random.uniformDouble();
  if (sum < threshold * current.path.target) return false;
  if (!(current.bidirectional > 0)) {
    double whole = 0;
    sampler_.complete(
        scene, random, current.path, minLength_,
        [&](const BidirectionalSampler::Connection& c) { whole += target_.target(c); });
    // The path itself is among the connections; rounding may not make it vanish.
    current.bidirectional = std::max(whole, double(current.path.target));
  }
  if (sum < threshold * current.bidirectional || !target_.evaluate(path)) return false;
  proposed.bidirectional = sum;
  logRatio = std::numeric_limits<double>::infinity();
  return true;
}

void BidirectionalLargeStep::splatProposal(const ChainState& proposed, double weight, double shared,
                                           SummedFilm& film) const {
  for (const auto& [c, target] : connections_) {
    // target / bidirectional is the probability of having picked this one.
    const double share = target / proposed.bidirectional / (target + shared);
    film.splat(c.filmX, c.filmY, c.contribution * static_cast<float>(weight * share));
  }
}

void BidirectionalLargeStep::splatSample(const ChainState&, double share, SummedFilm& film) const {
  for (const auto& [c, target] : connections_)
    film.splat(c.filmX, c.filmY, c.contribution * static_cast<float>(share / (target + share)));
}

}  // namespace h2mc
