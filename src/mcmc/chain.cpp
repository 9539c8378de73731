#include "mcmc/chain.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "render/integrator/parallel_rounds.h"
#include "render/path/path_text.h"

namespace h2mc {
namespace {

// One mutation in so many is timed: often enough to know the shares, seldom enough not to matter.
constexpr long long kTimedEvery = 64;

}  // namespace

Chain::Chain(const Target& target, const Path& start, Random random)
    : target_(target),
      current_(std::make_unique<ChainState>(target.maxLength())),
      proposed_(std::make_unique<ChainState>(target.maxLength())),
      random_(random) {
  current_->path.technique = start.technique;
  current_->path.sample = start.sample;
  [[maybe_unused]] const bool positive = target_.evaluate(current_->path);
  assert(positive);
}

void Chain::restart(const Path& from) {
  assert(from.target > 0);
  current_->forget();
  current_->path = from;
}

void Chain::flush(const KernelMixture& kernels, SummedFilm& film) {
  splatPending(kernels, film);
  weight_ = 0;
}

void Chain::splatPending(const KernelMixture& kernels, SummedFilm& film) const {
  const Path& path = current_->path;
  if (weight_ > 0) Mutation::splatPath(path, weight_, kernels.shared(path.technique), film);
}

void Chain::step(KernelMixture& kernels, ChainFilms& films, ChainStatistics& statistics,
                 MutationContext& context) {
  context.random = &random_;
  context.timed = steps_++ % kTimedEvery == 0;
  context.seconds = {};
  RaySeconds rays(context.timed);
  const double start = context.timed ? wallClock() : 0;

  const std::size_t kind = kernels.choose(current_->path, random_);
  Mutation* const mutation = &kernels.mutation(kind);

  proposed_->forget();
  proposed_->path.finite = true;
  double logRatio = 0;
  const bool made = mutation->propose(*current_, *proposed_, context, logRatio);
  double acceptance = 0;
  if (made) {
    logRatio += kernels.logRatio(kind, current_->path, proposed_->path);
    acceptance = acceptanceProbability(current_->path, proposed_->path, logRatio);
  } else if (!proposed_->path.finite) {
    if (statistics.notFinite++ == 0)
      statistics.firstNotFinite = pathText(proposed_->path.technique, proposed_->path.sample);
  }

  // Both states count with their expected weights [Veach 1997, section 11.4].
  weight_ += 1 - acceptance;
  AcceptanceCount& count =
      statistics.acceptance[kind][static_cast<std::size_t>(current_->path.technique.length())];
  count.add(acceptance);
  statistics.levels[kind][KernelMixture::at(kernels.level(current_->path.target))].add(acceptance);
  if (kind == 0) {
    const double estimate = kernels.large->lastEstimate();
    statistics.largeSteps.add(estimate);
    if (estimate > 0 && kernels.brightness > 0)
      kernels.large->splatSample(*proposed_, kernels.share(), films.samples);
  }
  if (acceptance > 0) {
    mutation->splatProposal(*proposed_, acceptance, kernels.shared(proposed_->path.technique),
                            films.states);
    if (random_.uniform() < acceptance) {
      flush(kernels, films.states);
      std::swap(current_, proposed_);
      moved_ = true;
    }
  }
  ++statistics.mutations;
  if (context.timed) {
    statistics.profile.add({1, wallClock() - start, rays.seconds(), context.seconds.derivatives,
                            context.seconds.gaussian});
  }
}

}  // namespace h2mc
